// Joints of a model as [[hinge]], [[prismatic]], [[ball_socket]] and their drives and motors.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "scenes/models/write_bodies.h"

namespace scenes {
namespace {

using physics::Pose;
using physics::Quat;
using physics::Vec3;

constexpr double kWaterDensity = 1000;  // kg/m^3

// A joint between two bodies, in world coordinates, Z up.
struct Joined {
  const ModelJoint& joint;
  WrittenBody from, to;
  Vec3 at, axis;
};

// [[word]] of these two bodies.
Value tableOf(const Joined& joined, const Words& words, const std::string& name) {
  Value table = words.table();
  if (!name.empty()) words.set(table, "name", words.text(name));
  words.set(table, "bodies", words.texts({joined.from.name, joined.to.name}));
  return table;
}

Vec3 inFrame(const Pose& frame, const Vec3& point) {
  return frame.q.conjugate() * (point - frame.x);
}

void setLimits(Value& table, const Joined& joined, ModelSurvey& survey, const Words& words) {
  const ModelJoint& joint = joined.joint;
  if (!joint.range) return;
  const bool turns = joint.kind == ModelJoint::Kind::kHinge;
  const double unit = turns ? 180 / M_PI : 1;
  const double low = unit * ((*joint.range)[0] - joint.start);
  const double high = unit * ((*joint.range)[1] - joint.start);
  if (turns && (low < -180 || high > 180)) {
    return survey.remark("a limit beyond half a turn is left open", joint.place);
  }
  words.set(table, "limits", words.array({words.number(low), words.number(high)}));
}

// What pulls the coordinate to `target`.
struct Pull {
  std::string name;
  double stiffness = 0, damping = 0, target = 0;
  std::optional<double> most;
};

void writeTurning(Written& written, const Joined& joined, const Pull& pull, const Words& words) {
  Value drive = tableOf(joined, words, pull.name);
  words.set(drive, "stiffness", words.number(pull.stiffness));
  words.set(drive, "damping", words.number(pull.damping));
  if (pull.most) words.set(drive, "max_torque", words.number(*pull.most));
  const double turn = pull.target - joined.joint.start;
  if (turn != 0 && pull.stiffness > 0) {
    const Quat there = physics::exponential(turn * joined.axis) * joined.to.frame.q;
    const Quat target = joined.from.frame.q.conjugate() * there;
    words.set(drive, "target", words.quaternion(target.normalized()));
  }
  words.add(written.root, "drive", std::move(drive));
}

// Two points that the slide keeps on its line: a spring of no length between them.
void writeSliding(Written& written, const Joined& joined, const Pull& pull, const Words& words) {
  if (pull.most) written.survey.leaveOut("the largest force of a sliding servo", words.place);
  Value spring = tableOf(joined, words, pull.name);
  const Vec3 from = joined.at + (pull.target - joined.joint.start) * joined.axis;
  words.set(spring, "anchors",
            words.vectors({inFrame(joined.from.frame, from), inFrame(joined.to.frame, joined.at)}));
  words.set(spring, "stiffness", words.number(pull.stiffness));
  words.set(spring, "damping", words.number(pull.damping));
  words.set(spring, "rest_length", words.number(0));
  words.add(written.root, "spring", std::move(spring));
}

void writePull(Written& written, const Joined& joined, const Pull& pull, const Place& place) {
  if (pull.stiffness == 0 && pull.damping == 0) return;
  const bool slides = joined.joint.kind == ModelJoint::Kind::kSlide;
  (slides ? writeSliding : writeTurning)(written, joined, pull, Words{place});
}

void writeServos(Written& written, const Joined& joined) {
  const ModelJoint& joint = joined.joint;
  writePull(written, joined, {joint.name, joint.stiffness, joint.damping, joint.rest, {}},
            joint.place);
  for (const ModelServo& servo : joint.servos) {
    const Words words{servo.place};
    if (servo.kind == ModelServo::Kind::kSpring) {
      writePull(written, joined,
                {servo.name, servo.stiffness, servo.damping, servo.target, servo.most},
                servo.place);
    } else if (joint.kind == ModelJoint::Kind::kHinge) {
      Value motor = tableOf(joined, words, servo.name);
      words.set(motor, "axis", words.vector(yUp(joined.axis)));
      words.set(motor, "stall_torque", words.number(servo.target));
      words.add(written.root, "motor_torque", std::move(motor));
    } else {
      written.survey.leaveOut("a motor of a slide", servo.place);
    }
  }
}

void writeJoint(Written& written, const Joined& joined) {
  const ModelJoint& joint = joined.joint;
  const Words words{joint.place};
  Value table = tableOf(joined, words, joint.name);
  words.set(table, "at", words.vector(yUp(joined.at)));
  const char* word = "ball_socket";
  if (joint.kind == ModelJoint::Kind::kBall) {
    if (joint.range) written.survey.leaveOut("the range of a ball joint", joint.place);
  } else {
    word = joint.kind == ModelJoint::Kind::kSlide ? "prismatic" : "hinge";
    words.set(table, "axis", words.vector(yUp(joined.axis)));
    setLimits(table, joined, written.survey, words);
  }
  words.add(written.root, word, std::move(table));
  writeServos(written, joined);
}

// Between two joints of one link: a body that only carries, so that each joint is one of ours.
WrittenBody writeRing(Written& written, const ModelLink& link, std::size_t index, const Pose& pose,
                      const Vec3& at) {
  const ModelJoint& joint = link.joints[index];
  const Words words{joint.place};
  const ModelInertial whole = inertialOf(link);
  const WrittenBody out{fmt::format("{}.ring{}", link.name, index), {at, pose.q}};
  const double mass = kRingShare * whole.mass;
  const double moment = kRingShare * principal(whole).moments.maxCoeff();
  Value body = words.table(), shape = words.table();
  words.set(body, "name", words.text(out.name));
  words.set(shape, "point", words.table());
  words.set(body, "shape", std::move(shape));
  words.set(body, "mass", words.number(mass));
  const double round = moment > 0 ? moment : mass * std::pow(mass / kWaterDensity, 2.0 / 3);
  words.set(body, "inertia", words.vector(Vec3::Constant(round)));
  const Pose here = yUp(out.frame);
  words.set(body, "position", words.vector(here.x));
  words.set(body, "quaternion", words.quaternion(here.q));
  words.add(written.root, "body", std::move(body));
  Value apart = words.table();
  words.set(apart, "body", words.text(out.name));
  words.add(written.root, "no_contact", std::move(apart));
  return out;
}

void writeLoop(Written& written, const ModelLoop& loop) {
  const auto a = static_cast<std::size_t>(loop.links[0]),
             b = static_cast<std::size_t>(loop.links[1]);
  const Words words{loop.place};
  if (written.bodies[a].name == written.bodies[b].name) {
    return written.survey.remark("an equality of one body with itself holds by itself", loop.place);
  }
  Value ball = words.table();
  if (!loop.name.empty()) words.set(ball, "name", words.text(loop.name));
  words.set(ball, "bodies", words.texts({written.bodies[a].name, written.bodies[b].name}));
  if (loop.welded) {
    Value lock = ball;
    words.add(written.root, "orientation_lock", std::move(lock));
  }
  words.set(ball, "at",
            words.vector(yUp((written.pose[a].x + written.pose[a].q * loop.at).eval())));
  words.add(written.root, "ball_socket", std::move(ball));
}

// A spring, a rope of that length, or both.
void writeString(Written& written, const ModelString& string) {
  const auto a = static_cast<std::size_t>(string.links[0]),
             b = static_cast<std::size_t>(string.links[1]);
  const WrittenBody &from = written.bodies[a], &to = written.bodies[b];
  const Words words{string.place};
  if (from.name == to.name) return;
  const Vec3 start = written.pose[a].x + written.pose[a].q * string.at[0];
  const Vec3 end = written.pose[b].x + written.pose[b].q * string.at[1];
  Value table = words.table();
  if (!string.name.empty()) words.set(table, "name", words.text(string.name));
  words.set(table, "bodies", words.texts({from.name, to.name}));
  words.set(table, "anchors", words.vectors({inFrame(from.frame, start), inFrame(to.frame, end)}));
  if (string.most) {
    Value rope = table;
    words.set(rope, "length", words.number(*string.most));
    words.set(rope, "rope", words.boolean(true));
    words.add(written.root, "distance", std::move(rope));
  }
  if (string.stiffness == 0 && string.damping == 0) return;
  words.set(table, "stiffness", words.number(string.stiffness));
  words.set(table, "damping", words.number(string.damping));
  if (string.rest) words.set(table, "rest_length", words.number(*string.rest));
  words.add(written.root, "spring", std::move(table));
}

}  // namespace

void writeJoints(Written& written) {
  for (std::size_t k = 1; k < written.whole.size(); ++k) {
    const ModelLink& link = written.whole[k];
    if (link.joints.empty()) continue;
    if (link.joints.size() > 6) {
      fail(written.survey.context(), link.place,
           fmt::format("body '{}': expected at most 6 joints, got {}", link.name,
                       link.joints.size()));
    }
    const Pose& pose = written.pose[k];
    WrittenBody from = written.bodies[static_cast<std::size_t>(link.parent)];
    for (std::size_t i = 0; i < link.joints.size(); ++i) {
      const ModelJoint& joint = link.joints[i];
      const bool last = i + 1 == link.joints.size();
      const Vec3 at = pose.x + pose.q * joint.at;
      const Vec3 next = last ? at : pose.x + pose.q * link.joints[i + 1].at;
      const WrittenBody to = last ? written.bodies[k] : writeRing(written, link, i, pose, next);
      writeJoint(written, {joint, from, to, at, pose.q * joint.axis});
      from = to;
    }
  }
  for (const ModelLoop& loop : written.model.loops) writeLoop(written, loop);
  for (const ModelString& string : written.model.strings) writeString(written, string);
}

}  // namespace scenes
