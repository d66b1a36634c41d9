// From a World's constraints to whole joints: a ball_socket and an axle between the same bodies are
// a hinge.
#include "app/peers/blueprint.h"

#include <algorithm>

#include "physics/base/rotation.h"

namespace app {
namespace {

using physics::BodyId;
using physics::Vec3;
using physics::World;
using Kind = PeerJoint::Kind;

constexpr double kSameAxis = 1e-9;  // 1 - cos of the angle between two that are meant as one
constexpr double kClosed = 1e-6;    // m

// What a pair of bodies has, before it is known which joint that is.
struct Parts {
  std::array<BodyId, 2> bodies{};
  std::optional<std::array<Vec3, 2>> ball;
  std::optional<std::array<Vec3, 2>> axle;
  std::optional<std::array<Vec3, 2>> cross;  // of a universal joint
  std::optional<std::array<Vec3, 2>> line;   // anchors of a point on a line
  Vec3 along = Vec3::Zero();                 // the line, in the first body's frame
  bool locked = false;
  std::optional<physics::TwistLimit> twist;
  std::optional<physics::ConeLimit> cone;
};

bool followsTable(const physics::ConstraintItem& constraint) {
  return std::visit(
      [](const auto& item) {
        if constexpr (requires { item.factor; }) return item.factor.table != nullptr;
        return false;
      },
      constraint.item);
}

class Reader {
 public:
  void take(const physics::ConstraintItem& item, Blueprint& plan) {
    if (plan.refusal.empty() && followsTable(item)) {
      plan.refusal = std::string("other engines have no table over time for a ") + item.kind;
    }
    if (plan.forces.take(item)) return;
    const std::string refusal = std::visit([&](const auto& c) { return add(c, plan); }, item.item);
    if (plan.refusal.empty() && !refusal.empty()) plan.refusal = refusal + item.kind;
  }

  void finish(Blueprint& plan) const {
    for (const Parts& parts : parts_) {
      const std::string refusal = addJoint(parts, plan);
      if (plan.refusal.empty()) plan.refusal = refusal;
    }
  }

 private:
  Parts& partsOf(const std::array<BodyId, 2>& bodies) {
    const auto same = [&](const Parts& p) { return p.bodies == bodies; };
    const auto found = std::find_if(parts_.begin(), parts_.end(), same);
    if (found != parts_.end()) return *found;
    parts_.emplace_back().bodies = bodies;
    return parts_.back();
  }

  template <class C>
  std::string add(const C&, Blueprint&) {
    return "other engines have no ";
  }
  std::string add(const physics::BallSocket& c, Blueprint& plan) {
    Parts& parts = partsOf(c.bodies);
    if (parts.ball) {  // a second one
      plan.joints.push_back({Kind::kBall, c.bodies, c.anchors, {}, 0, {}, {}});
    } else {
      parts.ball = c.anchors;
    }
    return "";
  }
  std::string add(const physics::Axle& c, Blueprint&) {
    partsOf(c.bodies).axle = {c.axisI, c.frameJ.col(2)};
    return "";
  }
  std::string add(const physics::Perpendicular& c, Blueprint&) {
    partsOf(c.bodies).cross = c.axes;
    return "";
  }
  std::string add(const physics::PointOnLine& c, Blueprint&) {
    Parts& parts = partsOf(c.bodies);
    parts.line = c.anchors;
    parts.along = c.frameI.col(2);
    return "";
  }
  std::string add(const physics::OrientationLock& c, Blueprint&) {
    partsOf(c.bodies).locked = true;
    return "";
  }
  std::string add(const physics::TwistLimit& c, Blueprint&) {
    partsOf(c.bodies).twist = c;
    return "";
  }
  std::string add(const physics::ConeLimit& c, Blueprint&) {
    Parts& parts = partsOf(c.bodies);
    if (parts.cone) return "other engines have no second ";
    parts.cone = c;
    return "";
  }
  std::string add(const physics::Distance& c, Blueprint& plan) {
    if (c.rope) return "other engines have no slack ";
    plan.joints.push_back({Kind::kDistance, c.bodies, c.anchors, {}, c.length, {}, {}});
    return "";
  }
  std::string add(const physics::Link& c, Blueprint& plan) {
    if (c.rope || c.compliance > 0) return "other engines have no slack or compliant ";
    plan.joints.push_back(
        {Kind::kDistance, c.bodies, {Vec3::Zero(), Vec3::Zero()}, {}, c.length, {}, {}});
    return "";
  }

  static std::string addJoint(const Parts& parts, Blueprint& plan) {
    PeerJoint joint;
    joint.bodies = parts.bodies;
    if (parts.line && parts.locked && !parts.ball && !parts.axle && !parts.cross && !parts.twist) {
      const auto& pose = plan.start.pose;
      joint.kind = Kind::kSlider;
      joint.anchors = *parts.line;
      joint.axes = {parts.along,
                    pose[joint.bodies[1]].q.conjugate() * (pose[joint.bodies[0]].q * parts.along)};
      plan.joints.push_back(joint);
      return "";
    }
    if (!parts.ball || parts.line || parts.locked || (parts.axle && parts.cross)) {
      return "other engines have no joint of these constraints between two bodies";
    }
    joint.anchors = *parts.ball;
    if (parts.cone) return addCone(parts, joint, plan);
    if (parts.axle) joint.kind = Kind::kHinge;
    if (parts.cross) joint.kind = Kind::kUniversal;
    if (parts.axle || parts.cross) joint.axes = parts.axle ? *parts.axle : *parts.cross;
    if (parts.twist) {
      const Vec3& n = parts.twist->axisI;
      if (!parts.axle || 1 - n.dot(joint.axes[0]) > kSameAxis) {
        return "other engines have no twist_limit but about the axis of a hinge";
      }
      const double now = parts.twist->twist({plan.start.pose, plan.start.pose, 0});
      joint.limits = {parts.twist->low - now, parts.twist->high - now};
    }
    plan.joints.push_back(joint);
    return "";
  }

  // A twist is counted about the middle of the cone, from the shortest swing to it.
  static std::string addCone(const Parts& parts, PeerJoint& joint, Blueprint& plan) {
    const Vec3 &centre = parts.cone->axes[0], &axis = parts.cone->axes[1];
    PeerCone cone{centre, parts.cone->angle, {-physics::kPi, physics::kPi}, {}};
    cone.reference = physics::turnBetween(axis, centre);
    if (parts.twist) {
      cone.reference = parts.twist->reference;
      cone.twist = {parts.twist->low, parts.twist->high};
    }
    const bool same = !parts.twist || 1 - parts.twist->axisI.dot(centre) <= kSameAxis;
    if (parts.axle || parts.cross || !same || 1 - (cone.reference * axis).dot(centre) > kSameAxis) {
      return "other engines have no cone_limit but of a ball_socket, about the axis of its "
             "twist_limit";
    }
    joint.cone = cone;
    plan.joints.push_back(joint);
    return "";
  }

  std::vector<Parts> parts_;
};

std::string softWord(const World& world) {
  bool hasVolume = false, hasRope = false;
  for (const physics::ConstraintItem& item : world.constraints()) {
    hasVolume = hasVolume || std::holds_alternative<physics::Volume>(item.item);
    hasRope = hasRope || std::holds_alternative<physics::RopeLength>(item.item);
  }
  return hasVolume ? "soft bodies" : hasRope ? "ropes" : "cloths";
}

std::string refusalOf(const World& world) {
  const physics::Bodies& b = world.bodies();
  if (world.settings().stepping == physics::Stepping::kStatic) {
    return "other engines do not solve without moving";
  }
  if (!world.arms().empty()) return "other engines have no arm";
  for (BodyId i = 1; i < b.size(); ++i) {
    if (std::holds_alternative<physics::Compound>(b.shape[i]) ||
        std::holds_alternative<physics::Triangles>(b.shape[i])) {
      return "bodies of several shapes and meshes of triangles are not handed to other engines";
    }
    if (world.settings().contact && b.restitution[i] != world.settings().contact->restitution) {
      return "other engines have one restitution, not one of each body";
    }
    if (b.isSoft[i])
      return "other engines have no " + softWord(world) + ": points with a thickness";
    if (b.friction[i].staticCoefficient != b.friction[i].dynamicCoefficient &&
        world.settings().contact) {
      return "other engines have one coefficient of friction, not a static and a dynamic one";
    }
    if (isMovable(world, i) && !isPoint(world, i) && !(b.inertia[i].minCoeff() > 0)) {
      return "other engines have no rigid body without inertia";
    }
  }
  return "";
}

// A point does not turn: a joint holds it at its centre or not at all.
std::string refusalOf(const World& world, const Blueprint& plan, const PeerJoint& joint) {
  for (int k = 0; k < 2; ++k) {
    if (isPoint(world, joint.bodies[k]) && isMovable(world, joint.bodies[k]) &&
        (!joint.anchors[k].isZero(0) ||
         (joint.kind != Kind::kBall && joint.kind != Kind::kDistance))) {
      return "other engines have no points that a joint holds beside their centre";
    }
  }
  const double open = (anchorAtStart(plan, joint, 0) - anchorAtStart(plan, joint, 1)).norm();
  const bool closed = joint.kind == Kind::kDistance || joint.kind == Kind::kSlider;
  if (!closed && open > kClosed) return "other engines start with joints closed";
  return "";
}

}  // namespace

bool isPoint(const World& world, BodyId body) {
  return std::holds_alternative<physics::PointShape>(world.bodies().shape[body]);
}

bool isMovable(const World& world, BodyId body) {
  return world.bodies().motion[body] == physics::Motion::kDynamic;
}

bool Blueprint::hasCones() const {
  return std::any_of(joints.begin(), joints.end(),
                     [](const PeerJoint& joint) { return joint.cone.has_value(); });
}

bool Blueprint::ignores(BodyId a, BodyId b) const {
  return std::binary_search(ignored.begin(), ignored.end(),
                            std::array{std::min(a, b), std::max(a, b)});
}

Vec3 anchorAtStart(const Blueprint& plan, const PeerJoint& joint, int side) {
  const physics::Pose& pose = plan.start.pose[joint.bodies[side]];
  return pose.x + pose.q * joint.anchors[side];
}

Vec3 axisAtStart(const Blueprint& plan, const PeerJoint& joint, int side) {
  return plan.start.pose[joint.bodies[side]].q * joint.axes[side];
}

Blueprint makeBlueprint(const World& world) {
  Blueprint plan;
  plan.start = {world.bodies().pose, world.bodies().velocity};
  plan.ignored = world.ignoredPairs();
  plan.refusal = refusalOf(world);
  Reader reader;
  for (const physics::ConstraintItem& item : world.constraints()) reader.take(item, plan);
  reader.finish(plan);
  for (const PeerJoint& joint : plan.joints) {
    if (plan.refusal.empty()) plan.refusal = refusalOf(world, plan, joint);
  }
  return plan;
}

}  // namespace app
