// Spring and damper between two points, (108)-(127).
//   scalar  c = |dp| [m], along d = dp/|dp|: f = -k (c - l) - nu dc/dt, so that it turns nothing
//   vector  c = dp [m], rest length zero:     f = -k dp - nu d(dp)/dt                        (108)
//   f [N] acts on body i at p_i, opposite on j; K = k h^2 + nu h is alpha of (115). The damper of
//   the vector form turns the pair by dp x f, NOTES 3.7. dp = 0 has no direction: the scalar form
//   does nothing there.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct SpringDef {
  static constexpr const char* kWord = "spring";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};  // body frames
  double stiffness = 100;                                   // N/m
  double damping = 0;                                       // N s/m
  std::optional<double> restLength;                         // m; absent: as at the start
  std::optional<Form> form;  // absent: the vector form where the rest length is zero
  bool collide = true;
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kNone, true}, d.bodies);
    v(Field{"anchors", Unit::kBodyPoint}, d.anchors);
    v(Field{"stiffness", Unit::kNewtonPerMetre, true, 0}, d.stiffness);
    v(Field{"damping", Unit::kNewtonSecondPerMetre, false, 0}, d.damping);
    v(Field{"rest_length", Unit::kMetre, false, 0}, d.restLength);
    v(Field{"form"}, d.form);
    v(Field{"collide"}, d.collide);
    Tuning::fields(v, d.tuning);
  }
};

struct Spring {
  static constexpr int kBodies = 2, kRows = 1;
  static constexpr bool kLinear = true;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};
  double stiffness = 100, damping = 0, restLength = 1;

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
  double energy(std::span<const Pose> pose) const;  // J
};

struct VectorSpring {
  static constexpr const char* kWord = "vector_spring";
  static constexpr int kBodies = 2, kRows = 3;
  static constexpr bool kLinear = true;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 2> bodies{};
  std::array<Vec3, 2> anchors{Vec3::Zero(), Vec3::Zero()};
  double stiffness = 100, damping = 0;

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
  double energy(std::span<const Pose> pose) const;  // J
};

}  // namespace physics
