// Hardening spring and damper between two points: stiffer the further it is stretched.
//   c = |dp| [m], s = c - l:  f = -(k s + k3 s^3) - nu dc/dt along d = dp/|dp|   (102)-(107)
//   K = (k + 3 k3 s^2) h^2 + nu h. dp = 0 has no direction and no force.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct HardeningSpringDef {
  static constexpr const char* kWord = "hardening_spring";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};  // body frames
  double stiffness = 100;                                   // k [N/m]
  double cubic = 100;                                       // k3 [N/m^3]
  double damping = 0;                                       // nu [N s/m]
  std::optional<double> restLength;                         // l [m]; absent: as at the start
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"anchors", Unit::kBodyPoint}, d.anchors);
    v(Field{"stiffness", Unit::kNewtonPerMetre, true, 0}, d.stiffness);
    v(Field{"cubic", Unit::kNone, true, 0}, d.cubic);
    v(Field{"damping", Unit::kNewtonSecondPerMetre, false, 0}, d.damping);
    v(Field{"rest_length", Unit::kMetre, false, 0}, d.restLength);
    Tuning::fields(v, d.tuning);
  }
};

struct HardeningSpring {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = true;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};
  double stiffness = 100, cubic = 100, damping = 0, restLength = 1;

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
  double energy(std::span<const Pose> pose) const;  // J
};

}  // namespace physics
