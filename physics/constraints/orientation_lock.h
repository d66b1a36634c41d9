// Orientation lock: body j keeps its orientation against body i.
//   c = log d, d = q_i^-1 q_j ref^-1: the turn of j past where it should be, in the frame of i
//   [rad] dc/dtheta_j = T(c) R_i^T, opposite for i;  T = 1 - [c]x/2 + (1/|c|^2 - cot(|c|/2)/(2|c|))
//   [c]x^2 is the inverse of the left Jacobian of the exponential (Sola et al., A micro Lie theory,
//   2018). At |c| = pi the shorter way is ambiguous: one is taken.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct OrientationLockDef {
  static constexpr const char* kWord = "orientation_lock";
  std::array<BodyId, 2> bodies{};
  std::optional<Quat>
      orientation;  // of bodies[1] in bodies[0]'s frame, to be kept; absent: as at the start
  bool collide = false;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"orientation"}, d.orientation);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

struct OrientationLock {
  static constexpr int kBodies = 2, kRows = 3;
  static constexpr bool kLinear = false;
  static constexpr const char* kUnit = "rad";
  std::array<BodyId, 2> bodies{};
  Quat reference = Quat::Identity();  // q_i^-1 q_j where c = 0

  bool isEquality() const { return true; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
