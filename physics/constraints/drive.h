// Drive: a damped angular spring towards a target orientation, with a torque limit; a muscle.
//   dtheta = log(q_j target^-1 q_i^-1), the turn of body j past its target against body i [rad]
//   (129) tau = -k dtheta - nu d(dtheta)/dt on body j, opposite on i, |tau| <= tau_max (128),(132)
//   as a force: c = dtheta, K = k h^2 + nu h, J = -1, +1                               (130)
//   At |dtheta| = pi the shorter way is ambiguous and one is taken.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"
#include "physics/constraints/over_time.h"

namespace physics {

struct DriveDef {
  static constexpr const char* kWord = "drive";
  std::array<BodyId, 2> bodies{};
  std::optional<Quat>
      target;             // orientation of bodies[1] in bodies[0]'s frame; absent: as at the start
  double stiffness = 20;  // k [N m/rad]
  double damping = 0.2;   // nu [N m s]
  double maxTorque = std::numeric_limits<double>::infinity();  // tau_max [N m]
  std::optional<OverTime> overTime{};  // of the turn from the start to the target
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"target"}, d.target);
    v(Field{"stiffness", Unit::kNewtonMetrePerRadian, true, 0}, d.stiffness);
    v(Field{"damping", Unit::kNewtonMetreSecond, false, 0}, d.damping);
    v(Field{"max_torque", Unit::kNewtonMetre, false, 0}, d.maxTorque);
    v(Field{"over_time"}, d.overTime);
    Tuning::fields(v, d.tuning);
  }
};

struct Drive {
  static constexpr int kBodies = 2, kRows = 3;
  static constexpr bool kLinear = false;
  static constexpr const char* kUnit = "rad";
  std::array<BodyId, 2> bodies{};
  Quat target = Quat::Identity();
  double stiffness = 20, damping = 0.2, maxTorque = std::numeric_limits<double>::infinity();
  Factor factor{};
  Quat start = Quat::Identity();  // where a factor of 0 aims at

  Quat aim() const;
  Vec3 error(std::span<const Pose> pose) const;  // dtheta, world frame [rad]
  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
  double energy(std::span<const Pose> pose) const;  // J, as if without a torque limit
};

}  // namespace physics
