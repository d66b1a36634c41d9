// Link: the centres of two bodies stay `length` apart; one piece of a rope or one edge of a cloth.
//   c = |x_i - x_j| - length [m]   dc/dx_i = d^T, dc/dx_j = -d^T, d = (x_i - x_j)/|x_i - x_j|
//   (133)-(135) It has no lever arms and costs no rotation. `compliance` s [m/N]: c = -s times the
//   tension. x_i = x_j: the direction of the start of the substep, or else the y axis, so that they
//   part.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct LinkDef {
  static constexpr const char* kWord = "link";
  std::array<BodyId, 2> bodies{};
  std::optional<double> length;  // m; absent: as at the start
  bool rope = false;             // resists only stretching
  double compliance = 0;         // m/N; 0: rigid
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"length", Unit::kMetre, false, 0}, d.length);
    v(Field{"rope"}, d.rope);
    v(Field{"compliance", Unit::kNone, false, 0}, d.compliance);
    Tuning::fields(v, d.tuning);
  }
};

struct Link {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  double length = 1, compliance = 0;
  bool rope = false;

  bool isEquality() const { return !rope && compliance == 0; }
  bool isOneSided() const { return rope && compliance == 0; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
