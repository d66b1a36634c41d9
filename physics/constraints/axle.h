// Axle: axis n_i of body i stays parallel to axis n_j of body j.
//   e = phi w,  phi = atan2(|n_i x n_j|, n_i . n_j),  w = n_i x n_j / |n_i x n_j| (80),(82) c =
//   components of e along two axes u, v normal to n_j and fixed in body j [rad], |c| = phi scalar
//   form: dphi/dtheta_i = -w, dphi/dtheta_j = +w                          (81), signs corrected
//   parallel: c = 0, J is regular; antiparallel: any w normal to n_i serves, e has length pi.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct AxleDef {
  static constexpr const char* kWord = "axle";
  std::array<BodyId, 2> bodies{};
  Vec3 axis = Vec3::UnitX();                // world direction at the start, in both bodies
  std::optional<std::array<Vec3, 2>> axes;  // instead of `axis`: each in its body's frame
  Form form = Form::kVector;
  bool collide = false;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"axis", Unit::kDirection}, d.axis);
    v(Field{"axes", Unit::kBodyPoint}, d.axes);
    v(Field{"form"}, d.form);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

struct Axle {
  static constexpr int kBodies = 2, kRows = 2;
  static constexpr bool kLinear = false;
  static constexpr const char* kUnit = "rad";
  std::array<BodyId, 2> bodies{};
  Vec3 axisI = Vec3::UnitX();      // body frame of i
  Mat3 frameJ = Mat3::Identity();  // columns u, v, n_j in the body frame of j
  Form form = Form::kVector;

  bool isEquality() const { return true; }
  void evaluate(const Configuration& x, Row<kBodies, kRows>& row) const;
};

}  // namespace physics
