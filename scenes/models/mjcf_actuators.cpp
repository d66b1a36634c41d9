// MJCF: <actuator>, <contact>, <equality>.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/models/mjcf.h"

namespace scenes {
namespace {

// None where it is one of those that are not read.
std::optional<int> linkNamed(const Tag& tag, const char* key, const Mjcf& mjcf) {
  const std::string name = tag.required(key);
  const auto found = mjcf.links.find(mjcf.named(name));
  if (found != mjcf.links.end()) return found->second;
  if (name == "world") return kWorldLink;
  if (mjcf.makesBodies) {
    tag.leaveOut(fmt::format("<{}> of bodies that are not read", tag.element().tag));
    return std::nullopt;
  }
  std::vector<std::string> known;
  for (const auto& [word, link] : mjcf.links) known.push_back(word);
  tag.fail(fmt::format("no body '{}'{}", name, didYouMean(mjcf.named(name), known)));
}

ModelJoint* jointOf(const Tag& tag, Mjcf& mjcf) {
  const std::string name = tag.text("joint", "");
  if (name.empty()) {
    tag.leaveOut(fmt::format("<{}> of anything but a joint", tag.element().tag));
    return nullptr;
  }
  const auto found = mjcf.joints.find(mjcf.named(name));
  if (mjcf.freeJoints.contains(mjcf.named(name))) {
    tag.leaveOut(fmt::format("<{}> of a free joint", tag.element().tag));
    return nullptr;
  }
  if (found == mjcf.joints.end()) {
    std::vector<std::string> known;
    for (const auto& [word, ref] : mjcf.joints) known.push_back(word);
    tag.fail(fmt::format("no joint '{}'{}", name, didYouMean(mjcf.named(name), known)));
  }
  const auto [link, joint] = found->second;
  return &mjcf.model.links[static_cast<std::size_t>(link)].joints[static_cast<std::size_t>(joint)];
}

// What the actuator pulls with where its control is 0: gain * 0 + bias, bias = -k q - nu dq/dt.
void readGains(const Tag& tag, ModelServo& servo) {
  const std::string& kind = tag.element().tag;
  if (kind == "position") {
    servo.stiffness = tag.number("kp", 1);
    servo.damping = tag.number("kv", 0);
    servo.perControl = 1;
  } else if (kind == "velocity") {
    servo.damping = tag.number("kv", 1);
  } else if (kind == "general" && tag.text("biastype", "none") == "affine") {
    const std::vector<double> bias = tag.numbers("biasprm");
    if (bias.size() > 0 && bias[0] != 0) tag.leaveOut("the constant of biasprm of <general>");
    if (bias.size() > 1) servo.stiffness = -bias[1];
    if (bias.size() > 2) servo.damping = -bias[2];
    const std::vector<double> gain = tag.numbers("gainprm");
    if (servo.stiffness > 0) servo.perControl = (gain.empty() ? 1 : gain[0]) / servo.stiffness;
  } else {
    servo.kind = ModelServo::Kind::kTorque;
    const std::vector<double> gain = tag.numbers("gainprm");
    servo.perControl = gain.empty() ? 1 : gain[0];
    return;
  }
  servo.kind = ModelServo::Kind::kSpring;
  if (servo.stiffness < 0 || servo.damping < 0) tag.fail("expected kp and kv >= 0");
}

void readActuator(const XmlElement& element, std::size_t index, Mjcf& mjcf) {
  static constexpr const char* kKinds[] = {"motor", "position", "velocity", "general"};
  const auto same = [&](const char* kind) { return element.tag == kind; };
  if (std::none_of(std::begin(kKinds), std::end(kKinds), same)) return;
  const Tag tag = tagOf(element, mjcf);
  ModelJoint* joint = jointOf(tag, mjcf);
  if (joint == nullptr) return;
  if (joint->kind == ModelJoint::Kind::kBall) return tag.leaveOut("an actuator of a ball joint");
  ModelServo servo;
  servo.index = index;
  servo.place = tag.place();
  servo.name = mjcf.named(tag.name(tag.text("joint", "")));
  readGains(tag, servo);
  const std::vector<double> gear = tag.numbers("gear"), force = tag.numbers("forcerange", 2);
  const double turned = gear.empty() ? 1 : gear[0], ratio = std::abs(turned);
  const bool isTorque = servo.kind == ModelServo::Kind::kTorque;
  servo.perControl = isTorque      ? turned * servo.perControl
                     : turned != 0 ? servo.perControl / turned
                                   : 0;
  servo.stiffness *= ratio * ratio;
  servo.damping *= ratio * ratio;
  if (!force.empty()) servo.most = ratio * std::max(std::abs(force[0]), std::abs(force[1]));
  joint->servos.push_back(std::move(servo));
}

void readLoop(const XmlElement& element, Mjcf& mjcf) {
  if (element.tag != "connect" && element.tag != "weld") return;
  const Tag tag = tagOf(element, mjcf);
  if (!tag.has("body1")) return tag.leaveOut(fmt::format("<{}> between sites", element.tag));
  if (!tag.flag("active", true))
    return tag.leaveOut(fmt::format("<{}> that is not active", element.tag));
  ModelLoop loop;
  loop.name = tag.text("name") ? mjcf.named(tag.name("")) : "";
  loop.place = tag.place();
  loop.welded = element.tag == "weld";
  const std::optional<int> first = linkNamed(tag, "body1", mjcf);
  const std::optional<int> second =
      tag.has("body2") ? linkNamed(tag, "body2", mjcf) : std::optional(kWorldLink);
  if (!first || !second) return;
  loop.links = {*first, *second};
  loop.at = tag.vector("anchor", physics::Vec3::Zero());
  if (tag.has("relpose")) tag.leaveOut("relpose of <weld>, whose bodies are held as they start");
  mjcf.model.loops.push_back(std::move(loop));
}

}  // namespace

void readActuators(Mjcf& mjcf) {
  for (const XmlElement* group : childrenOf(*mjcf.root, "actuator", mjcf.survey)) {
    mjcf.survey.seen(*group);
    for (const XmlElement& element : group->children) {
      readActuator(element, mjcf.actuators++, mjcf);
    }
  }
}

void readPairs(Mjcf& mjcf) {
  for (const XmlElement* group : childrenOf(*mjcf.root, "contact", mjcf.survey)) {
    for (const XmlElement* element : childrenOf(*group, "exclude", mjcf.survey)) {
      const Tag tag(*element, mjcf.survey);
      tag.name("");
      const std::optional<int> first = linkNamed(tag, "body1", mjcf);
      const std::optional<int> second = linkNamed(tag, "body2", mjcf);
      if (first && second) mjcf.model.apart.push_back({*first, *second});
    }
  }
  for (const XmlElement* group : childrenOf(*mjcf.root, "equality", mjcf.survey)) {
    mjcf.survey.seen(*group);
    for (const XmlElement& element : group->children) readLoop(element, mjcf);
  }
}

}  // namespace scenes
