// Bend: three points in a row resist being bent.
//   0---1---2   c = x_0 - 2 x_1 + x_2 [m]:  f = -k c - nu dc/dt, on 0 and 2; -2 f on 1 (102)-(107)
//   K = (k h^2 + nu h) 1, exact: c is linear. For a rod of bending stiffness E I in pieces of
//   length l, k = E I/l^3. It is straight at rest. sum x_i x f_i = c x f: the spring turns nothing,
//   the damper does by nu c x dc/dt.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct BendDef {
  static constexpr const char* kWord = "bend";
  std::array<BodyId, 3> bodies{};
  double stiffness = 10;  // k [N/m]
  double damping = 0;     // nu [N s/m]
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kBody, true}, d.bodies);
    v(Field{"stiffness", Unit::kNewtonPerMetre, true, 0}, d.stiffness);
    v(Field{"damping", Unit::kNewtonSecondPerMetre, false, 0}, d.damping);
    Tuning::fields(v, d.tuning);
  }
};

struct Bend {
  static constexpr int kBodies = 3, kRows = 3;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 3> bodies{};
  double stiffness = 10, damping = 0;

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
  double energy(std::span<const Pose> pose) const;  // J
};

}  // namespace physics
