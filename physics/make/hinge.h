// A hinge: ball and socket plus axle, and where asked a twist limit and a motor about the same
// axis.
#pragma once

#include "physics/make/matter.h"

namespace physics {

struct HingeMotor {
  double speed = 1;                                            // rad/s
  double maxTorque = std::numeric_limits<double>::infinity();  // N m
  std::optional<OverTime> overTime{};                          // of the speed
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"speed", Unit::kRadianPerSecond, true}, d.speed);
    v(Field{"max_torque", Unit::kNewtonMetre, false, 0}, d.maxTorque);
    v(Field{"over_time"}, d.overTime);
  }
};

struct HingeDef {
  static constexpr const char* kWord = "hinge";
  std::array<BodyId, 2> bodies{};
  Vec3 at = Vec3::Zero();     // world coordinates at the start
  Vec3 axis = Vec3::UnitX();  // world direction at the start
  std::optional<std::array<double, 2>>
      limits;  // turn of bodies[1] against bodies[0] [rad], 0 at the start
  std::optional<HingeMotor> motor;
  Form form = Form::kVector;
  bool collide = false;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"at", Unit::kPoint, true}, d.at);
    v(Field{"axis", Unit::kDirection, true}, d.axis);
    v(Field{"limits", Unit::kDegrees, false, -180, 180}, d.limits);
    v(Field{"motor"}, d.motor);
    v(Field{"form"}, d.form);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

void add(World& world, const HingeDef& def);

}  // namespace physics
