// Motor torque: a direct-current motor, whose torque falls off with its speed.
//   c = turn of body j against body i about n since t [rad]:  tau = tau_s (1 - (c/h)/omega_f) on j
//   K = tau_s h/omega_f. omega_f infinite: a constant torque. (102)-(107) n is an axis of body i.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"
#include "physics/constraints/over_time.h"

namespace physics {

struct MotorTorqueDef {
  static constexpr const char* kWord = "motor_torque";
  std::array<BodyId, 2> bodies{};
  Vec3 axis = Vec3::UnitX();                                   // world direction at the start
  double stallTorque = 1;                                      // tau_s [N m], either sign
  double freeSpeed = std::numeric_limits<double>::infinity();  // omega_f [rad/s]
  std::optional<OverTime> overTime{};                          // of the stall torque
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"axis", Unit::kDirection, true}, d.axis);
    v(Field{"stall_torque", Unit::kNewtonMetre, true}, d.stallTorque);
    v(Field{"free_speed", Unit::kRadianPerSecond, false, 1e-9}, d.freeSpeed);
    v(Field{"over_time"}, d.overTime);
    Tuning::fields(v, d.tuning);
  }
};

struct MotorTorque {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = false;
  static constexpr const char* kUnit = "rad";
  std::array<BodyId, 2> bodies{};
  Vec3 axisI = Vec3::UnitX();  // body frame of i
  double stallTorque = 1, freeSpeed = std::numeric_limits<double>::infinity();
  Factor factor{};

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
};

}  // namespace physics
