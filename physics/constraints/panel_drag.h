// Panel drag: wind on a triangle of three points, along its normal.
//        2
//       / \      c = mean of the corners' displacements since t [m], u = c/h - wind
//      0---1      f = -beta A |n.u| (n.u) n, shared by the corners; K = 2 beta A h |n.u| n n^T
//   A and n are the triangle's present area and normal; how they change is left out of K.
//   A flat line of three points has no area and no force.
#pragma once

#include "physics/base/fields.h"
#include "physics/constraints/constraint.h"

namespace physics {

struct PanelDragDef {
  static constexpr const char* kWord = "panel_drag";
  std::array<BodyId, 3> bodies{};
  double coefficient = 0.6;  // beta = rho C/2 [kg/m^3]
  Vec3 wind = Vec3::Zero();  // m/s
  Tuning tuning;
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"bodies", Unit::kBody, true}, d.bodies);
    v(Field{"coefficient", Unit::kNone, true, 0}, d.coefficient);
    v(Field{"wind"}, d.wind);
    Tuning::fields(v, d.tuning);
  }
};

struct PanelDrag {
  static constexpr int kBodies = 3, kRows = 3;
  static constexpr bool kLinear = true, kAngular = false;
  static constexpr const char* kUnit = "m";
  std::array<BodyId, 3> bodies{};
  double coefficient = 0.6;
  Vec3 wind = Vec3::Zero();

  void evaluate(const Configuration& x, Push<kBodies, kRows>& push) const;
};

}  // namespace physics
