// Cone limit: the angle between axis n_i of body i and axis n_j of body j stays within phi_l.
//   c = phi - phi_l <= 0 [rad], phi = atan2(|n_i x n_j|, n_i . n_j)                (88), with n for
//   w dc/dtheta_i = -w, dc/dtheta_j = +w; the total multiplier is clamped to <= 0     (89),(90)
//   corrected parallel: far inside any cone but the zero one, no direction needed; antiparallel:
//   any w normal to n_i.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct ConeLimitDef {
  static constexpr const char* kWord = "cone_limit";
  std::array<BodyId, 2> bodies{};
  Vec3 axis = Vec3::UnitX();                // world direction at the start, in both bodies
  std::optional<std::array<Vec3, 2>> axes;  // instead of `axis`: each in its body's frame
  double angle = 0.5;                       // phi_l [rad], 0..pi
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"axis", Unit::kDirection}, d.axis);
    v(Field{"axes", Unit::kBodyPoint}, d.axes);
    v(Field{"degrees", Unit::kDegrees, true, 0, 180}, d.angle);
    Tuning::fields(v, d.tuning);
  }
};

struct ConeLimit {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = false;
  static constexpr const char* kUnit = "rad";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> axes{Vec3::UnitX(), Vec3::UnitX()};  // body frames
  double angle = 0.5;

  bool isOneSided() const { return true; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
