// Spring and damper between two points, along the line that joins them.
//   f = -k (|dp| - l) - nu d|dp|/dt   (108) projected on d = dp/|dp|, so that it turns nothing
//   as a row: alpha = 1/(k h^2 + nu h), c = alpha (k h^2 (|dp| - l) + nu h (|dp| - |dp at t|))
//   (123)=(127) k = nu = 0 is no row at all; dp = 0 has no direction and no force.
#pragma once

#include "physics/constraint.h"
#include "physics/fields.h"

namespace physics {

struct SpringDef {
  static constexpr const char* kWord = "spring";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};  // body frames
  double stiffness = 100;                                   // N/m
  double damping = 0;                                       // N s/m
  std::optional<double> restLength;                         // m; absent: as at the start
  bool collide = true;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"anchors", Unit::kBodyPoint}, d.anchors);
    v(Field{"stiffness", Unit::kNewtonPerMetre, true, 0}, d.stiffness);
    v(Field{"damping", Unit::kNewtonSecondPerMetre, false, 0}, d.damping);
    v(Field{"rest_length", Unit::kMetre, false, 0}, d.restLength);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

struct Spring {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = true;
  static constexpr bool kForce = true;  // no error that could stand
  static constexpr const char* kUnit = "N";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};
  double stiffness = 100, damping = 0, restLength = 1;

  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
  double energy(std::span<const Pose> pose) const;  // J
};

}  // namespace physics
