// Point on a line: point p_j of body j stays on a line through p_i that is fixed in body i.
//   c = (u . d, v . d), d = p_j - p_i [m]; u, v normal to the line, fixed in body i
//   dc/dx_j = u^T, dc/dtheta_j = (r_j x u)^T, opposite for i with p_j - x_i in place of r_j: both
//   forces act at p_j. Never singular.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct PointOnLineDef {
  static constexpr const char* kWord = "point_on_line";
  std::array<BodyId, 2> bodies{};
  Vec3 at = Vec3::Zero();                      // both points, world coordinates at the start
  std::optional<std::array<Vec3, 2>> anchors;  // instead of `at`: each in its body's frame
  Vec3 axis = Vec3::UnitX();                   // the line's world direction at the start
  bool collide = false;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"at", Unit::kPoint}, d.at);
    v(Field{"anchors", Unit::kBodyPoint}, d.anchors);
    v(Field{"axis", Unit::kDirection, true}, d.axis);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

struct PointOnLine {
  static constexpr int kBodies = 2, kRows = 2;
  static constexpr bool kLinear = true;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};  // body frames
  Mat3 frameI = Mat3::Identity();  // columns u, v and the line, in the body frame of i

  bool isEquality() const { return true; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
