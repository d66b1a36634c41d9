// Volume: the tetrahedron of four points keeps its volume.
//        3
//       /|\       d_i = x_i - x_0
//      / | \      c = d_1 . (d_2 x d_3) - 6 V_0 [m^3]                                      (140)
//     0--|--2     dc/dx_1 = d_2 x d_3, dc/dx_2 = d_3 x d_1, dc/dx_3 = d_1 x d_2, dc/dx_0 = -their
//     sum
//      \ | /                                                                             (141)
//        1        positive for this orientation; an inverted one is pushed back through zero.
//   Four points on a line have no gradient and are left alone. mu and the update are (142), whose
//   factor 1/4 and whose c the generic solve has right.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct VolumeDef {
  static constexpr const char* kWord = "volume";
  std::array<BodyId, 4> bodies{};
  std::optional<double> volume;  // V_0 [m^3] > 0; absent: as at the start
  double compliance = 0;         // of c, 1/(pressure per c) [m^6/J]; 0: rigid
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kBody, true}, d.bodies);
    v(Field{"volume", Unit::kNone, false, std::numeric_limits<double>::min()}, d.volume);
    v(Field{"compliance", Unit::kNone, false, 0}, d.compliance);
    Tuning::fields(v, d.tuning);
  }
};

struct Volume {
  static constexpr int kBodies = 4, kRows = 1;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "1";
  std::array<BodyId, 4> bodies{};
  double volume = 1, compliance = 0;

  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
  double errorPerMetre() const;  // c of one that is off by about a metre [m^2]
  double relativeError(std::span<const Pose> pose) const;  // |V/V_0 - 1|
};

// Signed volume of the tetrahedron [m^3], positive where 1, 2, 3 turn right-handed seen from 0.
double volumeOf(const std::array<Vec3, 4>& corners);

}  // namespace physics
