// Point gravity: two bodies attract each other with the inverse square of their distance.
//   c = dp = x_i - x_j [m]:  f = -g dp/rho^3 on body i, rho^2 = |dp|^2 + eps^2       (102)-(107)
//   K = g h^2/rho^3 (1 - d d^T), the part of -df/dc that is not negative: along d the force grows
//   with the approach, and leaving that out of K costs iterations and changes no fixed point.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct PointGravityDef {
  static constexpr const char* kWord = "point_gravity";
  std::array<BodyId, 2> bodies{};
  double strength = 1;   // g = G m_i m_j [N m^2]
  double softening = 0;  // eps [m]
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"strength", Unit::kNone, true, 0}, d.strength);
    v(Field{"softening", Unit::kMetre, false, 0}, d.softening);
    Tuning::fields(v, d.tuning);
  }
};

struct PointGravity {
  static constexpr int kBodies = 2, kRows = 3;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  double strength = 1, softening = 0;

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
  double energy(std::span<const Pose> pose) const;  // J, negative
};

}  // namespace physics
