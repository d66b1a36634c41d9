// { box = { size } }, { sphere = { radius } } and the others: a table with exactly one known key.
#include "scenes/read/read_shape.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenes/scene.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;
using physics::Vec3;

void readRounded(TableReader& reader, double& radius, double& length) {
  reader(Field{"radius", Unit::kMetre, true, kPositive}, radius);
  reader(Field{"length", Unit::kMetre, true, kPositive}, length);
}

PlacedShape readPoint(TableReader&) { return {physics::PointShape{}, {}}; }

PlacedShape readBox(TableReader& reader) {
  physics::Box box;
  reader(Field{"size", Unit::kMetre, true, kPositive}, box.size);
  return {box, {}};
}

PlacedShape readSphere(TableReader& reader) {
  physics::Sphere sphere;
  reader(Field{"radius", Unit::kMetre, true, kPositive}, sphere.radius);
  return {sphere, {}};
}

PlacedShape readCapsule(TableReader& reader) {
  physics::Capsule capsule;
  readRounded(reader, capsule.radius, capsule.length);
  return {capsule, {}};
}

PlacedShape readCylinder(TableReader& reader) {
  physics::Cylinder cylinder;
  readRounded(reader, cylinder.radius, cylinder.length);
  return {cylinder, {}};
}

PlacedShape readPlane(TableReader& reader) {
  physics::Plane plane;
  reader(Field{"normal", Unit::kDirection}, plane.normal);
  reader(Field{"offset", Unit::kMetre}, plane.offset);
  plane.normal = plane.normal.stableNormalized();
  return {plane, {}};
}

PlacedShape readConvex(TableReader& reader) {
  std::string mesh;
  std::vector<Vec3> points;
  double scale = 1;
  reader(Field{"mesh"}, mesh);
  reader(Field{"points", Unit::kMetre}, points);
  reader(Field{"scale", Unit::kNone, false, kPositive}, scale);
  reader.exactlyOne("mesh", "points");
  if (reader.has("mesh")) {
    points = readObjVertices(mesh, *reader.take("mesh"), reader.spot(Field{"mesh"}));
  }
  for (Vec3& point : points) point *= scale;
  const char* source = reader.has("mesh") ? "mesh" : "points";
  if (points.size() < 4) {
    reader.failAt(source, fmt::format("expected at least 4 points, got {}", points.size()));
  }
  try {
    const physics::PrincipalHull hull = physics::makeHull(points);
    return {physics::Convex{hull.hull}, hull.toPoints};
  } catch (const std::invalid_argument& error) {
    reader.failAt(source, error.what());
  }
}

struct ShapeWord {
  const char* name;
  PlacedShape (*read)(TableReader&);
};
constexpr ShapeWord kShapes[] = {
    {"point", readPoint},     {"box", readBox},           {"sphere", readSphere},
    {"capsule", readCapsule}, {"cylinder", readCylinder}, {"convex", readConvex},
    {"plane", readPlane},
};

}  // namespace

std::string findMesh(const std::string& file, const Value& value, const Spot& spot) {
  namespace fs = std::filesystem;
  const fs::path beside = fs::path(folderOf(spot.context, value.place)) / file;
  const fs::path inAssets = fs::path(assetFolder()) / "meshes" / file;
  std::error_code ignored;
  if (fs::is_regular_file(beside, ignored)) return beside.string();
  if (fs::is_regular_file(inAssets, ignored)) return inAssets.string();
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(inAssets.parent_path(), ignored)) {
    names.push_back(entry.path().filename().string());
  }
  fail(spot.context, value.place,
       fmt::format("{}: no mesh '{}' beside the scene or in assets/meshes{}", spot.key, file,
                   didYouMean(file, names)));
}

std::vector<Vec3> readObjVertices(const std::string& file, const Value& value, const Spot& spot) {
  const std::string path = findMesh(file, value, spot);
  std::ifstream in(path);
  std::vector<Vec3> points;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word != "v") continue;
    Vec3 point = Vec3::Zero();
    if (!(words >> point.x() >> point.y() >> point.z()) || !point.allFinite()) {
      throw InputError(fmt::format("{}:{}: expected 'v x y z', got '{}'", path, number, line));
    }
    points.push_back(point);
  }
  if (points.empty()) {
    fail(spot.context, value.place,
         fmt::format("{}: expected a mesh with vertices, got the empty '{}'", spot.key, file));
  }
  return points;
}

PlacedShape readShape(const Value& value, const Spot& spot) {
  const bool one = value.isTable() && value.members.size() == 1;
  if (!one || !value.members[0].value.isTable()) {
    failExpected(spot, value, "one shape such as { box = { size = [1, 1, 1] } }");
  }
  const Member& member = value.members[0];
  std::vector<std::string> known;
  for (const ShapeWord& word : kShapes) {
    known.emplace_back(word.name);
    if (member.key != word.name) continue;
    TableReader reader(member.value, spot.key + "." + word.name, spot.context);
    PlacedShape shape = word.read(reader);
    reader.finish();
    return shape;
  }
  fail(spot.context, member.place,
       fmt::format("{}: unknown shape '{}'{}", spot.key, member.key,
                   nearestOrAll(member.key, known)));
}

void readValue(const Value& value, const Spot& spot, physics::Shape& out) {
  out = readShape(value, spot).shape;
  if (std::holds_alternative<physics::Plane>(out)) {
    failExpected(spot, value, "a shape with a volume");
  }
}

}  // namespace scenes
