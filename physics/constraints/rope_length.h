// Rope length: the way along a row of points has a total length; one constraint for all of them.
//   0---1---2-- ... --N   d_i = (x_i - x_{i+1})/|x_i - x_{i+1}|
//   c = sum |x_i - x_{i+1}| - length [m]   dc/dx_i = d_i - d_{i-1}, d_{-1} = d_N = 0 (136),(137)
//   One update moves every node where the rope bends, and only the ends where it is straight: it
//   stands beside the links, which keep the nodes in their places. mu is (138), the update (139).
//   A piece of zero length takes its direction from the start of the substep; straight with both
//   ends held, J M^-1 J^T = 0 and nothing is solved.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct RopeLengthDef {
  static constexpr const char* kWord = "rope_length";
  std::vector<BodyId> bodies;    // in their order along the rope, at least two
  std::optional<double> length;  // m; absent: as at the start
  bool rope = true;              // resists only stretching
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kBody, true}, d.bodies);
    v(Field{"length", Unit::kMetre, false, 0}, d.length);
    v(Field{"rope"}, d.rope);
    Tuning::fields(v, d.tuning);
  }
};

struct RopeLength {
  static constexpr int kBodies = kMany, kRows = 1;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "m";
  std::vector<BodyId> bodies;
  double length = 1;
  bool rope = true;

  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
