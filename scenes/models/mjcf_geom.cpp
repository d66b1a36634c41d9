// MJCF: <asset>, <geom>, <inertial>.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "physics/base/rotation.h"
#include "scenes/models/mesh_points.h"
#include "scenes/models/mjcf.h"

namespace scenes {
namespace {

using physics::Quat;
using physics::Vec3;

// Ours stand along y, MuJoCo's along z.
const Quat kAlongY = physics::exponential(M_PI / 2 * Vec3::UnitX());

void readMesh(const XmlElement& element, Mjcf& mjcf) {
  const Tag tag = tagOf(element, mjcf);
  MjcfMesh mesh;
  mesh.place = tag.place();
  mesh.scale = tag.vector("scale", Vec3::Ones());
  mesh.reference.x = tag.vector("refpos", Vec3::Zero());
  const std::vector<double> q = tag.numbers("refquat", 4);
  if (!q.empty()) mesh.reference.q = Quat(q[0], q[1], q[2], q[3]).normalized();
  const std::vector<double> points = tag.numbers("vertex");
  if (points.size() % 3 != 0) tag.fail("vertex: expected three numbers for each");
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    mesh.points.emplace_back(points[i], points[i + 1], points[i + 2]);
  }
  tag.text("face");
  namespace fs = std::filesystem;
  const std::string file = tag.text("file", "");
  mesh.read = !file.empty() || !points.empty();
  if (!mesh.read) tag.leaveOut("<mesh> that is made, not read from a file or vertices");
  mesh.path = (fs::path(mjcf.folder) / mjcf.compiler.meshFolder / file).string();
  mjcf.meshes[tag.name(fs::path(file).stem().string())] = std::move(mesh);
}

// Throws std::invalid_argument.
std::vector<Vec3> cornersOf(MjcfMesh& mesh) {
  if (mesh.points.empty()) mesh.points = meshPoints(mesh.path);
  std::vector<Vec3> points = mesh.points;
  const Quat turn = mesh.reference.q.conjugate();
  for (Vec3& point : points) point = turn * (point.cwiseProduct(mesh.scale) - mesh.reference.x);
  return hullCorners(points);
}

// The twelve corners of an icosahedron with edges of 2.
std::vector<Vec3> icosahedron() {
  const double t = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> corners;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-t, t}) {
      corners.insert(corners.end(), {Vec3(0, a, b), Vec3(a, b, 0), Vec3(b, 0, a)});
    }
  }
  return corners;
}

// The hull of 162 points: the corners of an icosahedron whose edges are divided in four. It has the
// ellipsoid's volume, so that the points lie 1.2 % outside of it.
std::vector<Vec3> ellipsoid(const Vec3& radii) {
  const std::vector<Vec3> corners = icosahedron();
  std::vector<Vec3> points = corners;
  const auto near = [&](std::size_t i, std::size_t j) {
    return (corners[i] - corners[j]).norm() < 2.1;
  };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t j = i + 1; j < corners.size(); ++j) {
      if (!near(i, j)) continue;
      for (int a = 1; a < 4; ++a) points.push_back(a * corners[i] + (4 - a) * corners[j]);
      for (std::size_t k = j + 1; k < corners.size(); ++k) {
        if (!near(i, k) || !near(j, k)) continue;
        const Vec3 sum = corners[i] + corners[j] + corners[k];
        for (const std::size_t one : {i, j, k}) points.push_back(sum + corners[one]);
      }
    }
  }
  for (Vec3& point : points) point.normalize();
  const double inside =
      physics::massProperties(physics::Convex{physics::makeHull(points).hull}).volume;
  const double grow = std::cbrt(4 * M_PI / 3 / inside);
  for (Vec3& point : points) point = grow * point.cwiseProduct(radii);
  return points;
}

// size[0], size[1], ...: positive, and as many as the shape has.
std::vector<double> sizeOf(const Tag& tag, std::size_t count) {
  std::vector<double> size = tag.numbers("size");
  if (size.size() < count)
    tag.fail(fmt::format("size: expected {} numbers, got {}", count, size.size()));
  for (std::size_t i = 0; i < count; ++i) {
    if (!(size[i] > 0)) tag.fail(fmt::format("size: expected numbers > 0, got {}", size[i]));
  }
  return size;
}

// The size of what stands along z, from two points where it is between such: puts it there.
std::vector<double> longSize(const Tag& tag, ModelPart& part, std::size_t count) {
  const std::vector<double> ends = tag.numbers("fromto", 6);
  if (ends.empty()) return sizeOf(tag, count);
  const Vec3 a(ends[0], ends[1], ends[2]), b(ends[3], ends[4], ends[5]);
  const double length = (b - a).norm();
  if (!(length > 1e-12)) tag.fail("fromto: expected two points that differ");
  part.pose = {(a + b) / 2, physics::turnBetween(Vec3::UnitZ(), (b - a) / length)};
  const double radius = sizeOf(tag, 1)[0];
  return count == 2 ? std::vector{radius, length / 2} : std::vector{radius, radius, length / 2};
}

void setPoints(const Tag& tag, ModelPart& part, std::vector<Vec3> points) {
  part.points = std::move(points);
  try {
    part.shape = physics::Convex{physics::makeHull(part.points).hull};
  } catch (const std::invalid_argument& error) {
    tag.fail(error.what());
  }
}

// What only is to be seen may miss its mesh.
bool isSeenOnly(const Tag& tag) {
  return tag.number("contype", 1) == 0 && tag.number("conaffinity", 1) == 0;
}

bool readMeshShape(const Tag& tag, Mjcf& mjcf, ModelPart& part) {
  const std::string name = tag.required("mesh");
  const auto found = mjcf.meshes.find(name);
  if (found == mjcf.meshes.end()) {
    std::vector<std::string> known;
    for (const auto& [word, mesh] : mjcf.meshes) known.push_back(word);
    tag.fail(fmt::format("no mesh '{}'{}", name, didYouMean(name, known)));
  }
  MjcfMesh& mesh = found->second;
  if (!mesh.read) {
    tag.leaveOut("<geom> of such a mesh");
    return false;
  }
  try {
    setPoints(tag, part, cornersOf(mesh));
  } catch (const std::invalid_argument& error) {
    const std::string what = fmt::format("<mesh>: {}: {}", mesh.path, error.what());
    if (!isSeenOnly(tag)) fail(tag.survey().context(), mesh.place, what);
    tag.survey().leaveOut(what, mesh.place);
    return false;
  }
  return true;
}

// False: a kind that is not read.
bool readShape(const Tag& tag, Mjcf& mjcf, ModelPart& part) {
  static constexpr const char* kTypes[] = {"plane",    "hfield", "sphere", "capsule", "ellipsoid",
                                           "cylinder", "box",    "mesh",   "sdf"};
  const std::string type = tag.choice("type", kTypes, tag.has("mesh") ? "mesh" : "sphere");
  if (type == "plane") {
    part.shape = physics::Plane{Vec3::UnitZ(), 0};
    tag.numbers("size");
  } else if (type == "sphere") {
    part.shape = physics::Sphere{sizeOf(tag, 1)[0]};
  } else if (type == "capsule" || type == "cylinder") {
    const std::vector<double> size = longSize(tag, part, 2);
    part.pose.q = part.pose.q * kAlongY;
    if (type == "capsule") part.shape = physics::Capsule{size[0], 2 * size[1]};
    if (type == "cylinder") part.shape = physics::Cylinder{size[0], 2 * size[1]};
  } else if (type == "box") {
    const std::vector<double> size = longSize(tag, part, 3);
    part.shape = physics::Box{2 * Vec3(size[0], size[1], size[2])};
  } else if (type == "ellipsoid") {
    const std::vector<double> size = longSize(tag, part, 3);
    setPoints(tag, part, ellipsoid({size[0], size[1], size[2]}));
  } else if (type == "mesh") {
    return readMeshShape(tag, mjcf, part);
  } else if (type == "hfield") {
    part.pose.q = part.pose.q * kAlongY;
    return readHeightShape(tag, mjcf, part);
  } else {
    tag.leaveOut(fmt::format("<geom> of type {}", type));
    return false;
  }
  return true;
}

void readLook(const Tag& tag, const Mjcf& mjcf, ModelPart& part) {
  std::vector<double> rgba = tag.numbers("rgba", 4);
  const std::string material = tag.text("material", "");
  const auto found = mjcf.materials.find(material);
  if (rgba.empty() && found != mjcf.materials.end() && found->second.rgba) {
    rgba.assign(found->second.rgba->begin(), found->second.rgba->end());
  }
  if (rgba.empty()) return;
  part.color = Vec3(rgba[0], rgba[1], rgba[2]).cwiseMax(0).cwiseMin(1);
  part.opacity = std::clamp(rgba[3], 0.0, 1.0);
}

unsigned bits(const Tag& tag, const char* key) {
  const double value = tag.number(key, 1);
  if (value < 0 || value > 4294967295.0) tag.fail(fmt::format("{}: expected 32 bits", key));
  return static_cast<unsigned>(value);
}

}  // namespace

void readAssets(Mjcf& mjcf) {
  for (const XmlElement* assets : childrenOf(*mjcf.root, "asset", mjcf.survey)) {
    for (const XmlElement* mesh : childrenOf(*assets, "mesh", mjcf.survey)) readMesh(*mesh, mjcf);
    for (const XmlElement* element : childrenOf(*assets, "hfield", mjcf.survey)) {
      readHeightField(*element, mjcf);
    }
    for (const XmlElement* element : childrenOf(*assets, "material", mjcf.survey)) {
      const Tag tag = tagOf(*element, mjcf);
      const std::vector<double> n = tag.numbers("rgba", 4);
      MjcfMaterial& material = mjcf.materials[tag.name("")];
      if (!n.empty()) material.rgba = {n[0], n[1], n[2], n[3]};
    }
  }
}

std::optional<ModelPart> readGeom(const Tag& tag, Mjcf& mjcf) {
  ModelPart part;
  part.place = tag.place();
  part.name = tag.text("name") ? mjcf.named(tag.name("")) : "";
  part.pose = poseOf(tag, mjcf);
  if (!readShape(tag, mjcf, part)) return std::nullopt;
  if (part.rows.empty()) part.mass = tag.number("mass");
  part.density = tag.number("density", 1000);
  if (part.mass.value_or(0) < 0 || part.density < 0) tag.fail("expected a mass >= 0");
  if (part.density == 0 && !part.mass) part.mass = 0;
  const std::vector<double> friction = tag.numbers("friction");
  part.friction = friction.empty() ? 1 : friction[0];
  if (*part.friction < 0) tag.fail("friction: expected numbers >= 0");
  part.type = bits(tag, "contype");
  part.affinity = bits(tag, "conaffinity");
  readLook(tag, mjcf, part);
  return part;
}

ModelInertial readInertial(const Tag& tag, const Mjcf& mjcf) {
  ModelInertial out;
  out.mass = tag.number("mass", 0);
  if (!(out.mass > 0)) tag.fail("mass: expected a number > 0");
  const physics::Pose pose = poseOf(tag, mjcf);
  const std::vector<double> full = tag.numbers("fullinertia", 6),
                            diagonal = tag.numbers("diaginertia", 3);
  if (full.empty() == diagonal.empty()) tag.fail("expected 'diaginertia' or 'fullinertia'");
  if (!full.empty()) {
    out.inertia << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5], full[2];
  } else {
    out.inertia = Vec3(diagonal[0], diagonal[1], diagonal[2]).asDiagonal();
  }
  return moved(out, pose);
}

}  // namespace scenes
