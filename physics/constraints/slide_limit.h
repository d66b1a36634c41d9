// Slide limit: how far point p_j of body j is along an axis of body i stays within [low, high].
//   s = n . (p_j - p_i) [m], n fixed in body i;  c = s - low >= 0 or s - high <= 0, whichever limit
//   is nearer; one multiplier, clamped in total
//   ds/dx_j = n^T, ds/dtheta_j = (r_j x n)^T, opposite for i with p_j - x_i in place of r_j
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct SlideLimitDef {
  static constexpr const char* kWord = "slide_limit";
  std::array<BodyId, 2> bodies{};
  Vec3 at = Vec3::Zero();                      // both points, world coordinates at the start
  std::optional<std::array<Vec3, 2>> anchors;  // instead of `at`: each in its body's frame
  Vec3 axis = Vec3::UnitX();                   // world direction at the start, fixed in bodies[0]
  std::array<double, 2> range{-0.5, 0.5};      // m; 0 where the points coincide
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"at", Unit::kPoint}, d.at);
    v(Field{"anchors", Unit::kBodyPoint}, d.anchors);
    v(Field{"axis", Unit::kDirection, true}, d.axis);
    v(Field{"limits", Unit::kMetre, true}, d.range);
    Tuning::fields(v, d.tuning);
  }
};

struct SlideLimit {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = true;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};  // body frames
  Vec3 axisI = Vec3::UnitX();                               // body frame of i
  double low = -0.5, high = 0.5;

  bool isOneSided() const { return true; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
