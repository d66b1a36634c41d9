// Force: a constant force on a body, at its centre of mass: a push, a thrust.
//   c = x - x(t) [m];  f = force, K = 0                                            (102)-(105)
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct ForceDef {
  static constexpr const char* kWord = "force";
  std::array<BodyId, 1> bodies{};
  Vec3 force = Vec3::Zero();  // N, world frame
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"body", Unit::kBody, true}, d.bodies);
    v(Field{"force", Unit::kNone, true}, d.force);
    Tuning::fields(v, d.tuning);
  }
};

struct ConstantForce {
  static constexpr int kBodies = 1, kRows = 3;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 1> bodies{};
  Vec3 force = Vec3::Zero();

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
    push.c = x.now[bodies[0]].x - x.start[bodies[0]].x;
    push.f = x.dt * x.dt * force;
    push.k.setZero();
    push.linear[0].setIdentity();
  }
};

}  // namespace physics
