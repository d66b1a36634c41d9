// Perpendicular: an axis n_i of body i and an axis n_j of body j stay at a right angle.
//   c = phi - pi/2, phi = atan2(|n_i x n_j|, n_i . n_j) [rad]
//   dc/dtheta_i = -w, dc/dtheta_j = +w, w = n_i x n_j / |n_i x n_j|, as of an axle (81)
//   parallel or antiparallel: any w normal to n_i serves.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct PerpendicularDef {
  static constexpr const char* kWord = "perpendicular";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> directions{Vec3::UnitX(), Vec3::UnitY()};  // world, at the start, one in each
  bool collide = false;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"directions", Unit::kDirection, true}, d.directions);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

struct Perpendicular {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = false;
  static constexpr const char* kUnit = "rad";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> axes{Vec3::UnitX(), Vec3::UnitY()};  // body frames

  bool isEquality() const { return true; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
