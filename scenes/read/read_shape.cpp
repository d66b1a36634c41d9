// { box = { size } }, { sphere = { radius } } and the others: a table with exactly one known key.
#include "scenes/read/read_shape.h"

#include <fmt/format.h>

#include <cmath>

#include "scenes/read/read_ground.h"
#include "scenes/read/read_obj.h"

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

PlacedShape readMesh(TableReader& reader) { return {readTriangles(reader), {}}; }
PlacedShape readField(TableReader& reader) { return {readHeights(reader), {}}; }

PlacedShape readConvex(TableReader& reader) {
  std::string mesh;
  std::vector<Vec3> points;
  double scale = 1;
  reader(Field{"mesh"}, mesh);
  reader(Field{"points", Unit::kMetre}, points);
  reader(Field{"scale", Unit::kNone, false, kPositive}, scale);
  reader.exactlyOne("mesh", "points");
  if (reader.has("mesh")) {
    points = readObj(mesh, *reader.take("mesh"), reader.spot(Field{"mesh"})).vertices;
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
    {"plane", readPlane},     {"triangles", readMesh},    {"heights", readField},
};

}  // namespace

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

PlacedShape readShapeOf(TableReader& reader) {
  const Value* shape = reader.take("shape");
  if (shape == nullptr) reader.failHere("expected a value for 'shape'");
  return readShape(*shape, reader.spot(Field{"shape"}));
}

void readValue(const Value& value, const Spot& spot, physics::Shape& out) {
  out = readShape(value, spot).shape;
  if (physics::isGroundOnly(out)) {
    failExpected(spot, value, "a shape with a volume");
  }
}

}  // namespace scenes
