// Twist limit: the turn of body j against body i about a common axis stays within [low, high].
//   The relative rotation d = q_i' q_j' (each with its reference frame, identity at the start) is
//   split into swing and twist about the axis n: tau = 2 atan2(d.vec . n, d.w) in (-pi, pi] c = tau
//   - low >= 0 or tau - high <= 0, whichever limit is nearer [rad]; one multiplier, clamped in
//   total dtau/dtheta: 1/2 (n + tan terms of the swing), exact (see the .cpp); singular for a swing
//   of pi.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct TwistLimitDef {
  static constexpr const char* kWord = "twist_limit";
  std::array<BodyId, 2> bodies{};
  Vec3 axis = Vec3::UnitX();               // world direction at the start, in both bodies
  std::array<double, 2> range{-0.5, 0.5};  // [rad], within (-pi, pi); 0 at the start
  std::optional<Quat> reference;  // orientation of bodies[1] in bodies[0]'s frame that counts as 0
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"axis", Unit::kDirection, true}, d.axis);
    v(Field{"degrees", Unit::kDegrees, true, -180, 180}, d.range);
    v(Field{"reference"}, d.reference);
    Tuning::fields(v, d.tuning);
  }
};

struct TwistLimit {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = false;
  static constexpr const char* kUnit = "rad";
  std::array<BodyId, 2> bodies{};
  Vec3 axisI = Vec3::UnitX();         // body frame of i
  Quat reference = Quat::Identity();  // q_i^-1 q_j at zero twist
  double low = -0.5, high = 0.5;

  double twist(const Configuration& x) const;  // rad
  bool isOneSided() const { return true; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
