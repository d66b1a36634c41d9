// Force: a force on a body, at its centre of mass: a push, a thrust. Constant, or over time.
//   c = x - x(t) [m];  f = force, K = 0                                            (102)-(105)
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"
#include "physics/constraints/over_time.h"

namespace physics {

struct ForceDef {
  static constexpr const char* kWord = "force";
  std::array<BodyId, 1> bodies{};
  Vec3 force = Vec3::Zero();  // N, world frame
  std::optional<OverTime> overTime{};
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"body", Unit::kBody, true}, d.bodies);
    v(Field{"force", Unit::kNone, true}, d.force);
    v(Field{"over_time"}, d.overTime);
    Tuning::fields(v, d.tuning);
  }
};

struct ConstantForce {
  static constexpr int kBodies = 1, kRows = 3;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 1> bodies{};
  Vec3 force = Vec3::Zero();
  Factor factor{};

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
    push.c = x.now[bodies[0]].x - x.start[bodies[0]].x;
    push.f = x.dt * x.dt * factor.now * force;
    push.k.setZero();
    push.linear[0].setIdentity();
  }
};

}  // namespace physics
