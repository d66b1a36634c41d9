// URDF: shapes, their meshes, colours and places.
#include "scenes/models/urdf_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "physics/base/rotation.h"
#include "scenes/models/mass.h"
#include "scenes/models/mesh_points.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;
using physics::Vec3;

double positive(const Tag& tag, const char* key) {
  tag.required(key);
  const double value = tag.number(key, 0);
  if (!(value > 0)) tag.fail(fmt::format("{}: expected a number > 0, got {}", key, value));
  return value;
}

}  // namespace

const XmlElement* childOf(const XmlElement& element, const char* tag, ModelSurvey& survey) {
  const auto found = childrenOf(element, tag, survey);
  return found.empty() ? nullptr : found.front();
}

// Roll, pitch and yaw: about axes that stay, x first.
physics::Pose originOf(const XmlElement& element, ModelSurvey& survey) {
  const XmlElement* origin = childOf(element, "origin", survey);
  if (origin == nullptr) return {};
  const Tag tag(*origin, survey);
  const Vec3 turn = tag.vector("rpy", Vec3::Zero());
  return {tag.vector("xyz", Vec3::Zero()), physics::exponential(turn.z() * Vec3::UnitZ()) *
                                               physics::exponential(turn.y() * Vec3::UnitY()) *
                                               physics::exponential(turn.x() * Vec3::UnitX())};
}

void UrdfParts::readMaterial(const XmlElement& element) {
  const Tag tag(element, survey);
  const XmlElement* color = childOf(element, "color", survey);
  if (color != nullptr) colors[tag.name("")] = Tag(*color, survey).numbers("rgba", 4);
}

std::optional<Vec3> UrdfParts::colorOf(const XmlElement& visual) {
  const XmlElement* material = childOf(visual, "material", survey);
  if (material == nullptr) return std::nullopt;
  readMaterial(*material);
  const auto found = colors.find(Tag(*material, survey).name(""));
  if (found == colors.end() || found->second.size() != 4) return std::nullopt;
  const std::vector<double>& rgba = found->second;
  return Vec3(rgba[0], rgba[1], rgba[2]).cwiseMax(0).cwiseMin(1).eval();
}

// package://robot/meshes/a.stl: in a folder above that has it, with or without the package's name.
std::string UrdfParts::findFile(const Tag& tag) const {
  std::string name = tag.required("filename");
  const bool inPackage = name.rfind("package://", 0) == 0 || name.rfind("model://", 0) == 0;
  if (name.rfind("file://", 0) == 0) name = name.substr(7);
  if (!inPackage) return (fs::path(folder) / name).lexically_normal().string();
  const std::string inside = name.substr(name.find("://") + 3);
  const std::string without = inside.substr(std::min(inside.find('/'), inside.size() - 1) + 1);
  std::error_code error;
  fs::path up = fs::absolute(folder.empty() ? "." : folder, error).lexically_normal();
  for (; !up.empty(); up = up.parent_path()) {
    for (const std::string& part : {inside, without}) {
      if (fs::is_regular_file(up / part, error)) return (up / part).string();
    }
    if (up == up.parent_path()) break;
  }
  tag.fail(fmt::format("no file '{}' in the folders above this file", inside));
}

bool UrdfParts::readMesh(const Tag& tag, ModelPart& part) {
  const std::string file = findFile(tag);
  const std::string ending = endingOf(file);
  if (ending != ".stl" && ending != ".obj") {
    tag.leaveOut(fmt::format("<mesh> of the kind '{}'", ending));
    return false;
  }
  const Vec3 scale = tag.vector("scale", Vec3::Ones());
  try {
    std::vector<Vec3> points = meshPoints(file);
    for (Vec3& point : points) point = point.cwiseProduct(scale);
    part.points = hullCorners(points);
    part.shape = physics::Convex{physics::makeHull(part.points).hull};
  } catch (const std::invalid_argument& error) {
    tag.fail(fmt::format("{}: {}", file, error.what()));
  }
  return true;
}

bool UrdfParts::readGeometry(const XmlElement& element, ModelPart& part) {
  const XmlElement* geometry = childOf(element, "geometry", survey);
  if (geometry == nullptr) Tag(element, survey).fail("expected a <geometry>");
  survey.seen(*geometry);
  // Ours stand along y, URDF's along z.
  const physics::Quat upright = physics::exponential(M_PI / 2 * Vec3::UnitX());
  for (const XmlElement& shape : geometry->children) {
    const Tag tag(shape, survey);
    if (shape.tag == "box") {
      const Vec3 size = tag.vector("size", Vec3::Zero());
      if (!(size.minCoeff() > 0)) tag.fail("size: expected three numbers > 0");
      part.shape = physics::Box{size};
    } else if (shape.tag == "sphere") {
      part.shape = physics::Sphere{positive(tag, "radius")};
    } else if (shape.tag == "cylinder" || shape.tag == "capsule") {
      const double radius = positive(tag, "radius"), length = positive(tag, "length");
      if (shape.tag == "cylinder") part.shape = physics::Cylinder{radius, length};
      if (shape.tag == "capsule") part.shape = physics::Capsule{radius, length};
      part.pose.q = part.pose.q * upright;
    } else if (shape.tag == "mesh") {
      return readMesh(tag, part);
    } else {
      tag.leaveOut(fmt::format("<geometry> of the kind <{}>", shape.tag));
      return false;
    }
    return true;
  }
  Tag(*geometry, survey).fail("expected a shape in it");
}

std::optional<ModelPart> UrdfParts::read(const XmlElement& element) {
  const Tag tag(element, survey);
  ModelPart part;
  part.place = tag.place();
  part.name = tag.name("");
  part.pose = originOf(element, survey);
  if (!readGeometry(element, part)) return std::nullopt;
  return part;
}

}  // namespace scenes
