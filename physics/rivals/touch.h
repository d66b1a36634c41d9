// A contact point as the rival methods see it, whatever touches: two rigid bodies, or a link of
// something soft and a rigid body.
//   c = sum_b weight_b (x_b + arm_b) . n = gap [m],  dc/dx_b = weight_b n^T,
//   dc/dtheta_b = weight_b (arm_b x n)^T                                             (91)-(94)
#pragma once

#include "physics/constraints/contact.h"
#include "physics/constraints/soft_contact.h"

namespace physics {

struct Touch {
  std::array<BodyId, 3> bodies{};
  std::array<double, 3> weight{};
  std::array<Vec3, 3> arm{};  // from the centres of mass to the point, world
  int count = 2;              // of bodies
  Vec3 n = Vec3::UnitY();     // world
  double gap = 0;             // m
  double startGap = 0;        // at the start of the substep [m]
  Vec3 moved = Vec3::Zero();  // what the matter at the point moved by since the substep began [m]
  double least = 0;           // floor of the link's share of the resistance [1/kg]
  Friction friction;
};

Touch touchOf(const ContactPair& pair, int k, std::span<const Pose> pose);
Touch touchOf(const SoftContact& contact, const Bodies& bodies);

// M^-1 J^T and A = J M^-1 J^T of one direction d at a touch.
struct TouchRow {
  Vec3 d = Vec3::UnitY();
  std::array<Vec3, 3> linear{}, turn{};
  double resistance = 0;
};
TouchRow rowOf(const Touch& touch, const Vec3& d, std::span<const InverseMass> inverse);

// Relative velocity [m/s] of the matter at the point.
Vec3 velocityOf(const Touch& touch, std::span<const Velocity> velocity);

// v += M^-1 J^T impulse.
void push(const Touch& touch, const TouchRow& row, double impulse, std::span<Velocity> velocity);

}  // namespace physics
