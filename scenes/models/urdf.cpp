// URDF: a robot of links and joints, their shapes, masses and limits.
#include "scenes/models/urdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "scenes/models/mass.h"
#include "scenes/models/urdf_parts.h"

namespace scenes {
namespace {

using physics::Pose;
using physics::Vec3;

struct UrdfJoint {
  std::string parent, child, type;
  Pose origin;
  ModelJoint joint;
  Place place;
};

struct UrdfReader {
  const XmlElement& root;
  UrdfParts parts;
  ModelSurvey& survey;
  Model& model;
  std::map<std::string, ModelLink> links{};
  std::map<std::string, bool> stated{};  // links with a mass of their own
  std::vector<UrdfJoint> joints{};

  void readLink(const XmlElement& element);
  void readJoint(const XmlElement& element);
  void build();
  void place(const std::string& name, int parent, const UrdfJoint* by);
};

ModelInertial inertialOfUrdf(const XmlElement& element, ModelSurvey& survey) {
  ModelInertial out;
  survey.seen(element);
  if (const XmlElement* mass = childOf(element, "mass", survey)) {
    const Tag tag(*mass, survey);
    out.mass = tag.number("value", 0);
    if (out.mass < 0) tag.fail("value: expected a mass >= 0");
  }
  if (const XmlElement* inertia = childOf(element, "inertia", survey)) {
    const Tag tag(*inertia, survey);
    const double xx = tag.number("ixx", 0), xy = tag.number("ixy", 0), xz = tag.number("ixz", 0),
                 yy = tag.number("iyy", 0), yz = tag.number("iyz", 0), zz = tag.number("izz", 0);
    out.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  }
  return moved(out, originOf(element, survey));
}

// As Bullet has it: that of its shapes, of as much mass.
void takeInertiaOfShapes(ModelLink& link, ModelSurvey& survey) {
  ModelInertial own;
  for (const ModelPart& part : link.parts) own = sum(own, inertialOf(part));
  if (!(own.mass > 0)) return;
  link.inertial->inertia = link.inertial->mass / own.mass * own.inertia;
  survey.remark("a mass without moments of inertia: they are those of its shapes", link.place);
}

void UrdfReader::readLink(const XmlElement& element) {
  const Tag tag(element, survey);
  ModelLink link;
  link.place = tag.place();
  link.name = tag.required("name");
  // Each hangs on the one before it, at the most: place() goes down by recursion.
  if (links.size() > 2000) tag.fail("expected at most 2000 links");
  if (links.contains(link.name)) tag.fail(fmt::format("a second link '{}'", link.name));
  if (const XmlElement* inertial = childOf(element, "inertial", survey)) {
    link.inertial = inertialOfUrdf(*inertial, survey);
    stated[link.name] = link.inertial->mass > 0;
  }
  const auto visuals = childrenOf(element, "visual", survey);
  const auto collisions = childrenOf(element, "collision", survey);
  for (std::size_t i = 0; i < collisions.size(); ++i) {
    std::optional<ModelPart> part = parts.read(*collisions[i]);
    if (!part) continue;
    const std::size_t same = visuals.size() == collisions.size() ? i : 0;
    const auto color = visuals.empty() ? std::nullopt : parts.colorOf(*visuals[same]);
    part->color = color;
    link.parts.push_back(std::move(*part));
  }
  if (!visuals.empty() && !collisions.empty()) {
    survey.leaveOut("<visual> of links that have a <collision>, which is drawn", visuals[0]->place);
    for (const XmlElement* visual : visuals) survey.seenWhole(*visual);
  }
  for (const XmlElement* visual : collisions.empty() ? visuals : collisions) {
    if (!collisions.empty()) break;
    std::optional<ModelPart> part = parts.read(*visual);
    if (!part) continue;
    part->type = part->affinity = 0;
    part->color = parts.colorOf(*visual);
    if (!link.inertial) part->mass = 0;
    link.parts.push_back(std::move(*part));
  }
  if (link.inertial && link.inertial->mass > 0 && link.inertial->inertia.isZero(0)) {
    takeInertiaOfShapes(link, survey);
  }
  links[link.name] = std::move(link);
}

void UrdfReader::readJoint(const XmlElement& element) {
  static constexpr const char* kTypes[] = {"revolute", "continuous", "prismatic", "fixed",
                                           "floating", "planar",     "spherical"};
  const Tag tag(element, survey);
  UrdfJoint out;
  out.place = out.joint.place = tag.place();
  out.joint.name = tag.required("name");
  tag.required("type");
  out.type = tag.choice("type", kTypes, "");
  if (out.type == "planar") tag.fail("a planar joint is not known: write it as two prismatic ones");
  for (const char* end : {"parent", "child"}) {
    const XmlElement* link = childOf(element, end, survey);
    if (link == nullptr) tag.fail(fmt::format("expected a <{}>", end));
    const std::string name = Tag(*link, survey).required("link");
    if (!links.contains(name)) {
      std::vector<std::string> known;
      for (const auto& [word, one] : links) known.push_back(word);
      Tag(*link, survey).fail(fmt::format("no link '{}'{}", name, didYouMean(name, known)));
    }
    (std::string(end) == "parent" ? out.parent : out.child) = name;
  }
  out.origin = originOf(element, survey);
  out.joint.kind = out.type == "prismatic"   ? ModelJoint::Kind::kSlide
                   : out.type == "spherical" ? ModelJoint::Kind::kBall  // of Bullet's
                                             : ModelJoint::Kind::kHinge;
  out.joint.axis = Vec3::UnitX();
  if (const XmlElement* axis = childOf(element, "axis", survey)) {
    const Tag one(*axis, survey);
    out.joint.axis = one.vector("xyz", Vec3::UnitX());
    if (!(out.joint.axis.norm() > 1e-12) && out.type != "fixed")
      one.fail("xyz: expected a direction");
    out.joint.axis.stableNormalize();
  }
  if (const XmlElement* limit = childOf(element, "limit", survey)) {
    const Tag one(*limit, survey);
    const double low = one.number("lower", 0), high = one.number("upper", 0);
    if (low > high) one.fail("lower: expected a number <= upper");
    if (out.type == "revolute" || out.type == "prismatic") out.joint.range = {low, high};
    one.number("effort");
  }
  if (const XmlElement* dynamics = childOf(element, "dynamics", survey)) {
    out.joint.damping = Tag(*dynamics, survey).number("damping", 0);
    if (out.joint.damping < 0) Tag(*dynamics, survey).fail("damping: expected a number >= 0");
  }
  if (out.type == "revolute" || out.type == "continuous") {
    ModelServo motor;
    motor.name = out.joint.name;
    motor.place = out.place;
    out.joint.servos.push_back(motor);
  }
  joints.push_back(std::move(out));
}

void UrdfReader::place(const std::string& name, int parent, const UrdfJoint* by) {
  ModelLink link = links.at(name);
  links.erase(name);
  link.parent = parent;
  if (by != nullptr) link.pose = by->origin;
  if (by != nullptr && by->type == "floating") {
    if (parent != kWorldLink)
      survey.leaveOut("a floating joint between two links: the link is free", by->place);
    link.free = true;
  } else if (by != nullptr && by->type != "fixed") {
    link.joints.push_back(by->joint);
  }
  const bool moves = by != nullptr && by->type != "fixed";
  if (moves && !link.inertial) {
    survey.remark(fmt::format("link '{}' states no mass: that of its shapes in water", name),
                  link.place);
  }
  const int index = static_cast<int>(model.links.size());
  model.links.push_back(std::move(link));
  for (const UrdfJoint& joint : joints) {
    if (joint.parent != name) continue;
    if (!links.contains(joint.child)) {
      fail(survey.context(), joint.place,
           fmt::format("<joint>: link '{}' has two parents, or is its own", joint.child));
    }
    place(joint.child, index, &joint);
  }
}

void UrdfReader::build() {
  std::vector<std::string> roots;
  for (const auto& link : links) {
    const std::string& name = link.first;
    const auto isChild = [&](const UrdfJoint& joint) { return joint.child == name; };
    if (std::none_of(joints.begin(), joints.end(), isChild)) roots.push_back(name);
  }
  if (roots.size() != 1) {
    fail(survey.context(), root.place,
         fmt::format("<robot>: expected one link that is no joint's child, got {}", roots.size()));
  }
  place(roots[0], kWorldLink, nullptr);
  model.links[1].free = stated[roots[0]];  // as Bullet has it: without a mass it does not move
  if (!links.empty()) {
    fail(survey.context(), links.begin()->second.place,
         fmt::format("<link>: '{}' hangs on nothing", links.begin()->first));
  }
  std::vector<int> all;
  for (int k = 1; k < static_cast<int>(model.links.size()); ++k) all.push_back(k);
  model.apart.push_back(all);  // as Bullet and Gazebo have it where nothing is said
}

}  // namespace

Model readUrdf(const XmlElement& root, const std::string& path, ModelSurvey& survey) {
  Model model;
  const Tag tag(root, survey);
  model.title = tag.name("");
  model.place = root.place;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  UrdfReader reader{root, {folder, survey}, survey, model};
  for (const XmlElement* one : childrenOf(root, "material", survey))
    reader.parts.readMaterial(*one);
  for (const XmlElement* one : childrenOf(root, "link", survey)) reader.readLink(*one);
  for (const XmlElement* one : childrenOf(root, "joint", survey)) reader.readJoint(*one);
  reader.build();
  return model;
}

}  // namespace scenes
