// Springs, drives, drag and point gravity as explicit forces.
#include "app/peers/forces.h"

#include <algorithm>
#include <cmath>

namespace app {
namespace {

using physics::BodyId;
using physics::Vec3;

constexpr double kCoincident = 1e-12;  // m: below, a distance has no direction

using Ends = std::array<BodyId, 2>;
using Anchors = std::array<Vec3, 2>;

struct Pull {
  const PeerState& state;
  std::vector<PeerLoad>& loads;

  Vec3 arm(BodyId b, const Vec3& anchor) const { return state.pose[b].q * anchor; }
  Vec3 point(BodyId b, const Vec3& anchor) const { return state.pose[b].x + arm(b, anchor); }
  Vec3 speed(BodyId b, const Vec3& anchor) const {
    return state.velocity[b].v + state.velocity[b].w.cross(arm(b, anchor));
  }
  Vec3 apart(const Ends& ends, const Anchors& anchors) const {
    return point(ends[0], anchors[0]) - point(ends[1], anchors[1]);
  }
  Vec3 parting(const Ends& ends, const Anchors& anchors) const {
    return speed(ends[0], anchors[0]) - speed(ends[1], anchors[1]);
  }

  void push(const Ends& ends, const Anchors& anchors, const Vec3& force) const {
    for (int k = 0; k < 2; ++k) {
      const Vec3 f = k == 0 ? force : Vec3(-force);
      loads[ends[k]].force += f;
      loads[ends[k]].torque += arm(ends[k], anchors[k]).cross(f);
    }
  }
  void turn(const Ends& ends, const Vec3& torque) const {  // on the second, opposite on the first
    loads[ends[0]].torque -= torque;
    loads[ends[1]].torque += torque;
  }
  Vec3 turning(const Ends& ends) const {
    return state.velocity[ends[1]].w - state.velocity[ends[0]].w;
  }

  // A force along the line between two points, of its length and the rate of that.
  template <class Law>
  void along(const Ends& ends, const Anchors& anchors, const Law& law) const {
    const Vec3 dp = apart(ends, anchors);
    const double distance = dp.norm();
    if (distance <= kCoincident) return;
    const Vec3 d = dp / distance;
    push(ends, anchors, law(distance, d.dot(parting(ends, anchors))) * d);
  }

  void operator()(const physics::Spring& s) const {
    along(s.bodies, s.anchors, [&](double length, double rate) {
      return -s.stiffness * (length - s.restLength) - s.damping * rate;
    });
  }
  void operator()(const physics::HardeningSpring& s) const {
    along(s.bodies, s.anchors, [&](double length, double rate) {
      const double stretch = length - s.restLength;
      return -(s.stiffness + s.cubic * stretch * stretch) * stretch - s.damping * rate;
    });
  }
  void operator()(const physics::VectorSpring& s) const {
    push(s.bodies, s.anchors,
         -s.stiffness * apart(s.bodies, s.anchors) - s.damping * parting(s.bodies, s.anchors));
  }
  void operator()(const physics::PointGravity& g) const {
    const Vec3 dp = apart(g.bodies, {Vec3::Zero(), Vec3::Zero()});
    const double rho = std::sqrt(dp.squaredNorm() + g.softening * g.softening);
    if (rho > kCoincident) {
      push(g.bodies, {Vec3::Zero(), Vec3::Zero()}, -g.strength / (rho * rho * rho) * dp);
    }
  }
  void operator()(const physics::ConstantForce& push) const {
    loads[push.bodies[0]].force += push.force;
  }
  void operator()(const physics::Drag& drag) const {
    const Vec3 u = state.velocity[drag.bodies[0]].v - drag.wind;
    loads[drag.bodies[0]].force -= drag.coefficient * u.norm() * u;
  }
  void operator()(const physics::Drive& drive) const {
    const Vec3 torque =
        -drive.stiffness * drive.error(state.pose) - drive.damping * turning(drive.bodies);
    const double size = torque.norm();
    turn(drive.bodies, size > drive.maxTorque ? Vec3(drive.maxTorque / size * torque) : torque);
  }
  void operator()(const physics::MotorTorque& motor) const {
    const Vec3 n = state.pose[motor.bodies[0]].q * motor.axisI;
    turn(motor.bodies,
         motor.stallTorque * (1 - n.dot(turning(motor.bodies)) / motor.freeSpeed) * n);
  }
};

}  // namespace

bool PeerForces::take(const physics::ConstraintItem& constraint) {
  return std::visit(
      [&](const auto& item) {
        if constexpr (std::is_constructible_v<Force, const decltype(item)&>) {
          forces_.emplace_back(item);
          return true;
        } else {
          return false;
        }
      },
      constraint.item);
}

const std::vector<PeerLoad>& PeerForces::evaluate(const PeerState& state) {
  loads_.assign(state.pose.size(), PeerLoad{});
  for (const Force& force : forces_) std::visit(Pull{state, loads_}, force);
  return loads_;
}

}  // namespace app
