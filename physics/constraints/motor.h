// Motor: turns body j against body i about an axis at a wanted speed, with a torque limit.
//   c = (turn about n since t) - speed h [rad]   J = -n, +n, n the axis of body i   total within +-
//   tau_max h^2
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"
#include "physics/constraints/over_time.h"

namespace physics {

struct MotorDef {
  static constexpr const char* kWord = "motor";
  std::array<BodyId, 2> bodies{};
  Vec3 axis = Vec3::UnitX();  // world direction at the start, fixed in bodies[0]
  double speed = 1;           // rad/s
  double maxTorque = std::numeric_limits<double>::infinity();  // N m
  std::optional<OverTime> overTime{};                          // of the speed
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"axis", Unit::kDirection, true}, d.axis);
    v(Field{"speed", Unit::kRadianPerSecond, true}, d.speed);
    v(Field{"max_torque", Unit::kNewtonMetre, false, 0}, d.maxTorque);
    v(Field{"over_time"}, d.overTime);
    Tuning::fields(v, d.tuning);
  }
};

// The turn of the second body against the first since the start of the substep, world frame [rad].
inline Vec3 turnSince(const Configuration& x, const std::array<BodyId, 2>& bodies) {
  return logarithm(x.now[bodies[1]].q * x.start[bodies[1]].q.conjugate()) -
         logarithm(x.now[bodies[0]].q * x.start[bodies[0]].q.conjugate());
}

struct Motor {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = false;
  static constexpr bool kOfVelocity = true;
  static constexpr const char* kUnit = "rad";
  std::array<BodyId, 2> bodies{};
  Vec3 axisI = Vec3::UnitX();  // body frame of i
  double speed = 1, maxTorque = std::numeric_limits<double>::infinity();
  Factor factor{};

  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
