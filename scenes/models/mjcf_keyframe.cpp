// MJCF: <keyframe>: a pose to start in.
#include <fmt/format.h>

#include <algorithm>

#include "physics/base/rotation.h"
#include "scenes/joined.h"
#include "scenes/models/mjcf.h"

namespace scenes {
namespace {

using physics::Pose;
using physics::Quat;
using physics::Vec3;

// The numbers of a key, joint by joint, in the order of bodies.
struct Numbers {
  const Tag& tag;
  const std::vector<double>& all;
  std::size_t at = 0;

  double next() {
    if (at >= all.size()) tag.fail(fmt::format("qpos: expected more than {} numbers", all.size()));
    return all[at++];
  }
  Vec3 vector() {
    const double x = next(), y = next(), z = next();
    return {x, y, z};
  }
  Quat turn() {
    const double w = next();
    const Vec3 v = vector();
    const Quat q(w, v.x(), v.y(), v.z());
    if (!(q.norm() > 1e-12)) tag.fail("qpos: expected quaternions that are not zero");
    return q.normalized();
  }
};

// Moves a link along or about a joint, and says the joint again in the frame that comes of it.
void moveBy(ModelJoint& joint, Numbers& numbers, Pose& pose) {
  if (joint.kind == ModelJoint::Kind::kSlide) {
    const double to = numbers.next();
    pose.x += pose.q * ((to - joint.start) * joint.axis);
    joint.start = to;
    return;
  }
  Quat turn;
  if (joint.kind == ModelJoint::Kind::kBall) {
    turn = numbers.turn();
  } else {
    const double to = numbers.next();
    turn = physics::exponential((to - joint.start) * joint.axis);
    joint.start = to;
  }
  const Vec3 at = pose.x + pose.q * joint.at;
  pose.q = (pose.q * turn).normalized();
  pose.x = at - pose.q * joint.at;
}

// Of several joints of a link each turns those that come after it.
void moveLink(ModelLink& link, Numbers& numbers) {
  if (link.free) {
    link.pose.x = numbers.vector();
    link.pose.q = numbers.turn();
    return;
  }
  std::vector<Pose> met;  // where the link was when a joint had moved it
  for (ModelJoint& joint : link.joints) {
    moveBy(joint, numbers, link.pose);
    met.push_back(link.pose);
  }
  const Quat back = link.pose.q.conjugate();
  for (std::size_t k = 0; k < met.size(); ++k) {
    ModelJoint& joint = link.joints[k];
    joint.at = back * (met[k].x + met[k].q * joint.at - link.pose.x);
    joint.axis = back * (met[k].q * joint.axis);
  }
}

void takeControls(const Tag& tag, Model& model) {
  const std::vector<double> controls = tag.numbers("ctrl");
  for (ModelLink& link : model.links) {
    for (ModelJoint& joint : link.joints) {
      for (ModelServo& servo : joint.servos) {
        if (servo.index < controls.size()) servo.target = servo.perControl * controls[servo.index];
      }
    }
  }
}

void start(const Tag& tag, Mjcf& mjcf) {
  const std::vector<double> all = tag.numbers("qpos");
  if (mjcf.makesBodies) return tag.leaveOut("<key> of bodies that are not read");
  if (!all.empty()) {
    Numbers numbers{tag, all};
    for (ModelLink& link : mjcf.model.links) moveLink(link, numbers);
    if (numbers.at != all.size()) {
      tag.fail(fmt::format("qpos: expected {} numbers, got {}", numbers.at, all.size()));
    }
  }
  const std::vector<double> speeds = tag.numbers("qvel");
  if (std::any_of(speeds.begin(), speeds.end(), [](double v) { return v != 0; })) {
    tag.leaveOut("qvel of <key>: it starts from rest");
  }
  takeControls(tag, mjcf.model);
}

}  // namespace

void readKeyframes(Mjcf& mjcf, const std::string& wanted) {
  std::vector<const XmlElement*> keys;
  std::vector<std::string> names;
  for (const XmlElement* group : childrenOf(*mjcf.root, "keyframe", mjcf.survey)) {
    for (const XmlElement* key : childrenOf(*group, "key", mjcf.survey)) {
      mjcf.survey.seenWhole(*key);
      const XmlAttribute* name = key->find("name");
      names.push_back(name == nullptr ? fmt::format("{}", keys.size()) : name->text);
      keys.push_back(key);
    }
  }
  if (wanted.empty()) {
    if (keys.empty()) return;
    return mjcf.survey.remark(
        fmt::format("starts as it is drawn; --set keyframe={} starts in that <key>",
                    joined(names, " | ")),
        keys[0]->place);
  }
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found == names.end()) {
    throw InputError(fmt::format("--set keyframe={}: no <key> '{}'{}", wanted, wanted,
                                 nearestOrAll(wanted, names)));
  }
  start(Tag(*keys[static_cast<std::size_t>(found - names.begin())], mjcf.survey), mjcf);
}

}  // namespace scenes
