// Ball and socket: point p_i of body i and point p_j of body j coincide.
//   c = dp = p_i - p_j [m]   dc/dx_i = 1, dc/dtheta_i = -[r_i]x, opposite for j        (71)-(73)
//   The scalar form (61)-(68) has the same c and J, and the resistance along dp only: its impulse
//   is parallel to dp, so that it turns nothing even while the joint is open (5.1). At dp = 0 both
//   do nothing.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct BallSocketDef {
  static constexpr const char* kWord = "ball_socket";
  std::array<BodyId, 2> bodies{};
  Vec3 at = Vec3::Zero();                      // both points, world coordinates at the start
  std::optional<std::array<Vec3, 2>> anchors;  // instead of `at`: each in its body's frame
  Form form = Form::kVector;
  bool collide = false;  // the two bodies may touch
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"at", Unit::kPoint}, d.at);
    v(Field{"anchors", Unit::kBodyPoint}, d.anchors);
    v(Field{"form"}, d.form);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

struct BallSocket {
  static constexpr int kBodies = 2, kRows = 3;
  static constexpr bool kLinear = true;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};  // body frames
  Form form = Form::kVector;

  bool isEquality() const { return true; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
