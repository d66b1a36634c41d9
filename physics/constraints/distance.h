// Distance: two points stay `length` apart; the link of a rope (133)-(135).
//   c = |dp| - length [m]   dc/dx_i = d^T, dc/dtheta_i = (r_i x d)^T, d = dp/|dp|, opposite for j
//   dp = 0: no direction; the row rests on the y axis, so that coincident points part.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct DistanceDef {
  static constexpr const char* kWord = "distance";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};  // body frames
  std::optional<double> length;                             // m; absent: as at the start
  bool rope = false;                                        // resists only stretching
  bool collide = true;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"anchors", Unit::kBodyPoint}, d.anchors);
    v(Field{"length", Unit::kMetre, false, 0}, d.length);
    v(Field{"rope"}, d.rope);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

struct Distance {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = true;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};
  double length = 1;
  bool rope = false;

  bool isEquality() const { return !rope; }
  bool isOneSided() const { return rope; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
