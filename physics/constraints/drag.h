// Drag: air or water that slows a body down with the square of its speed.
//   c = x - x(t) [m], u = c/h - wind:  f = -beta |u| u        (102)-(107)
//   K = beta h (|u| 1 + u u^T/|u|). It acts at the centre of mass. u = 0: no force, K = 0.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct DragDef {
  static constexpr const char* kWord = "drag";
  std::array<BodyId, 1> bodies{};
  double coefficient = 0.1;  // beta = rho C_d A/2 [N s^2/m^2]
  Vec3 wind = Vec3::Zero();  // m/s
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"body", Unit::kBody, true}, d.bodies);
    v(Field{"coefficient", Unit::kNone, true, 0}, d.coefficient);
    v(Field{"wind"}, d.wind);
    Tuning::fields(v, d.tuning);
  }
};

struct Drag {
  static constexpr int kBodies = 1, kRows = 3;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 1> bodies{};
  double coefficient = 0.1;
  Vec3 wind = Vec3::Zero();

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
};

}  // namespace physics
