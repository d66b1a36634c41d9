// MJCF: <worldbody>, <body>, <joint>, and what repeats or attaches bodies.
#include <fmt/format.h>

#include <cmath>

#include "physics/base/rotation.h"
#include "scenes/models/mjcf.h"

namespace scenes {
namespace {

using physics::Pose;
using physics::Vec3;

// Where the elements of a body are read to, and how they are turned and named.
struct Inside {
  int link = kWorldLink;
  Pose frame;          // of a <frame> or <replicate>, in the link's
  std::string around;  // the class of what states none
};

struct BodyReader {
  Mjcf& mjcf;

  void children(const XmlElement& element, const Inside& inside);
  void body(const XmlElement& element, const Inside& inside);
  void joint(const XmlElement& element, const Inside& inside);
  void site(const XmlElement& element, const Inside& inside);
  void frame(const XmlElement& element, Inside inside);
  void replicate(const XmlElement& element, const Inside& inside);
  void attach(const XmlElement& element, const Inside& inside);
  ModelLink& link(int index) { return mjcf.model.links[static_cast<std::size_t>(index)]; }
};

std::string childClass(const Tag& tag, const Mjcf& mjcf, const std::string& around) {
  const std::string own = tag.text("childclass", "");
  if (own.empty() || mjcf.classes.contains(own)) return own.empty() ? around : own;
  tag.fail(fmt::format("childclass: no class '{}'", own));
}

void BodyReader::children(const XmlElement& element, const Inside& inside) {
  mjcf.survey.seen(element);
  for (const XmlElement& child : element.children) {
    if (child.tag == "body") {
      body(child, inside);
    } else if (child.tag == "geom") {
      const Tag tag = tagOf(child, mjcf, inside.around);
      std::optional<ModelPart> part = readGeom(tag, mjcf);
      if (!part) continue;
      mjcf.model.parts += 1;
      mjcf.model.points += part->points.size();
      if (mjcf.model.parts > kMostParts || mjcf.model.points > kMostPoints) {
        tag.fail(fmt::format("expected at most {} shapes and {} points of their hulls", kMostParts,
                             kMostPoints));
      }
      part->pose = inside.frame * part->pose;
      link(inside.link).parts.push_back(std::move(*part));
    } else if (child.tag == "joint" || child.tag == "freejoint") {
      joint(child, inside);
    } else if (child.tag == "site") {
      site(child, inside);
    } else if (child.tag == "inertial") {
      const Tag tag(child, mjcf.survey);
      if (mjcf.compiler.inertia == MjcfCompiler::Inertia::kParts) {
        mjcf.survey.seenWhole(child);
      } else {
        link(inside.link).inertial = moved(readInertial(tag, mjcf), inside.frame);
      }
    } else if (child.tag == "frame") {
      frame(child, inside);
    } else if (child.tag == "replicate") {
      replicate(child, inside);
    } else if (child.tag == "attach") {
      attach(child, inside);
    } else if (child.tag == "composite" || child.tag == "flexcomp") {
      mjcf.makesBodies = true;
    }
  }
}

void BodyReader::body(const XmlElement& element, const Inside& inside) {
  const Tag tag(element, mjcf.survey);
  ModelLink next;
  const int index = static_cast<int>(mjcf.model.links.size());
  if (mjcf.model.links.size() > kMostLinks) {
    tag.fail(fmt::format("expected at most {} bodies", kMostLinks));
  }
  next.name = mjcf.named(tag.name(fmt::format("body{}", index)));
  next.place = tag.place();
  next.parent = inside.link;
  next.pose = inside.frame * poseOf(tag, mjcf);
  mjcf.model.links.push_back(next);
  mjcf.links[next.name] = index;
  children(element, {index, {}, childClass(tag, mjcf, inside.around)});
}

void BodyReader::joint(const XmlElement& element, const Inside& inside) {
  const Tag tag = tagOf(element, mjcf, inside.around);
  ModelLink& to = link(inside.link);
  if (inside.link == kWorldLink) tag.fail("expected a body that moves, not the world");
  if (element.tag == "freejoint" || tag.text("type", "hinge") == "free") {
    if (to.parent != kWorldLink) tag.fail("expected a free joint in a body of the world only");
    mjcf.freeJoints.insert(mjcf.named(tag.name("")));
    to.free = true;
    return;
  }
  ModelJoint next = readJoint(tag, mjcf);
  next.at = inside.frame.x + inside.frame.q * next.at;
  next.axis = inside.frame.q * next.axis;
  if (!next.name.empty()) {
    mjcf.joints[next.name] = {inside.link, static_cast<int>(to.joints.size())};
  }
  to.joints.push_back(std::move(next));
}

// A point with a name: how it is drawn does not matter.
void BodyReader::site(const XmlElement& element, const Inside& inside) {
  const Tag tag = tagOf(element, mjcf, inside.around);
  mjcf.survey.seenWhole(element);
  if (!tag.has("name")) return;
  const Vec3 at = inside.frame.x + inside.frame.q * tag.vector("pos", Vec3::Zero());
  const std::string name = tag.name("");
  mjcf.sites[mjcf.named(name)] = {inside.link, at};
  if (!mjcf.suffix.empty()) mjcf.repeated[name].push_back(mjcf.suffix);
}

void BodyReader::frame(const XmlElement& element, Inside inside) {
  const Tag tag(element, mjcf.survey);
  tag.name("");
  inside.frame = inside.frame * poseOf(tag, mjcf);
  inside.around = childClass(tag, mjcf, inside.around);
  children(element, inside);
}

void BodyReader::replicate(const XmlElement& element, const Inside& inside) {
  const Tag tag(element, mjcf.survey);
  const double count = tag.number("count", 0);
  if (count < 1 || count > kMostLinks || count != std::floor(count)) {
    tag.fail(fmt::format("count: expected an integer from 1 to {}", kMostLinks));
  }
  const Pose step{tag.vector("offset", Vec3::Zero()), poseOf(tag, mjcf).q};
  const std::string between = tag.text("sep", ""), suffix = mjcf.suffix;
  const std::size_t digits = fmt::format("{}", static_cast<int>(count) - 1).size();
  Inside here = inside;
  for (int k = 0; k < static_cast<int>(count); ++k) {
    mjcf.suffix = fmt::format("{}{}{:0{}}", suffix, between, k, digits);
    children(element, here);
    here.frame = here.frame * step;
  }
  mjcf.suffix = suffix;
}

// The <body> of this name; null where there is none.
const XmlElement* findBody(const XmlElement& element, const std::string& name) {
  for (const XmlElement& child : element.children) {
    const XmlAttribute* own = child.find("name");
    if (child.tag == "body" && own != nullptr && own->text == name) return &child;
    const XmlElement* inner = findBody(child, name);
    if (inner != nullptr) return inner;
  }
  return nullptr;
}

void BodyReader::attach(const XmlElement& element, const Inside& inside) {
  const Tag tag(element, mjcf.survey);
  const std::string name = tag.required("model"), body = tag.text("body", "");
  const auto found = mjcf.attachable.find(name);
  if (found == mjcf.attachable.end()) tag.fail(fmt::format("no model '{}' in <asset>", name));
  Mjcf part = *found->second;
  part.prefix = mjcf.prefix + tag.text("prefix", "") + part.prefix;
  part.suffix += mjcf.suffix;
  for (const XmlElement* world : childrenOf(*part.root, "worldbody", mjcf.survey)) {
    const XmlElement* one = body.empty() ? nullptr : findBody(*world, body);
    if (one != nullptr) BodyReader{part}.body(*one, {inside.link, inside.frame, ""});
    if (body.empty()) BodyReader{part}.children(*world, inside);
  }
  if (!body.empty() && part.links.empty())
    tag.fail(fmt::format("no body '{}' in '{}'", body, name));
  readActuators(part);
  readPairs(part);
  readTendons(part);
}

}  // namespace

std::optional<std::array<double, 2>> rangeOf(const Tag& tag, const MjcfCompiler& compiler,
                                             double unit) {
  static constexpr const char* kLimited[] = {"auto", "true", "false"};
  const std::vector<double> range = tag.numbers("range", 2);
  const std::string limited = tag.choice("limited", kLimited, "auto");
  const bool isLimited = limited == "true" || (limited == "auto" && compiler.autoLimits);
  if (range.empty() || !isLimited) return std::nullopt;
  if (range[0] > range[1]) tag.fail("range: expected the smaller number first");
  return std::array{range[0] * unit, range[1] * unit};
}

ModelJoint readJoint(const Tag& tag, const Mjcf& mjcf) {
  static constexpr const char* kTypes[] = {"hinge", "slide", "ball", "free"};
  const std::string type = tag.choice("type", kTypes, "hinge");
  ModelJoint joint;
  joint.kind = type == "slide"  ? ModelJoint::Kind::kSlide
               : type == "ball" ? ModelJoint::Kind::kBall
                                : ModelJoint::Kind::kHinge;
  const double unit = joint.kind == ModelJoint::Kind::kSlide ? 1 : mjcf.compiler.angle;
  joint.name = tag.text("name") ? mjcf.named(tag.name("")) : "";
  joint.place = tag.place();
  joint.at = tag.vector("pos", Vec3::Zero());
  joint.axis = tag.vector("axis", Vec3::UnitZ());
  if (!(joint.axis.norm() > 1e-12)) tag.fail("axis: expected a direction");
  joint.axis.normalize();
  joint.range = rangeOf(tag, mjcf.compiler, unit);
  joint.start = tag.number("ref", 0) * unit;
  joint.rest = tag.number("springref", 0) * unit;
  const std::vector<double> stiffness = tag.numbers("stiffness"), damping = tag.numbers("damping");
  joint.stiffness = stiffness.empty() ? 0 : stiffness[0];
  joint.damping = damping.empty() ? 0 : damping[0];
  if (stiffness.size() > 1 || damping.size() > 1)
    tag.leaveOut("higher orders of stiffness and damping");
  if (joint.stiffness < 0 || joint.damping < 0) tag.fail("expected stiffness and damping >= 0");
  return joint;
}

void readBodies(Mjcf& mjcf) {
  for (const XmlElement* element : childrenOf(*mjcf.root, "worldbody", mjcf.survey)) {
    BodyReader{mjcf}.children(*element, {});
  }
}

}  // namespace scenes
