// Springs, drives, drag, gravity between bodies and pushes as forces at the start of a step: what
// users of engines write that have no such thing of their own. Explicit, so stable only while omega
// h < 2.
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "physics/constraints/constraint_item.h"

namespace app {

struct PeerState {
  std::vector<physics::Pose> pose;  // by BodyId
  std::vector<physics::Velocity> velocity;
};

struct PeerLoad {
  physics::Vec3 force = physics::Vec3::Zero();   // N, at the centre of mass
  physics::Vec3 torque = physics::Vec3::Zero();  // N m, world frame
};

class PeerForces {
 public:
  bool take(const physics::ConstraintItem& item);  // false: not a force that it knows
  bool empty() const { return forces_.empty(); }
  // The loads of all forces, by BodyId.
  const std::vector<PeerLoad>& evaluate(const PeerState& state);

 private:
  using Force = std::variant<physics::Spring, physics::VectorSpring, physics::HardeningSpring,
                             physics::PointGravity, physics::ConstantForce, physics::Drag,
                             physics::Drive, physics::MotorTorque>;
  std::vector<Force> forces_;
  std::vector<PeerLoad> loads_;
};

}  // namespace app
