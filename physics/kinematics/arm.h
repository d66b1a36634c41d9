// An arm in joint coordinates: where its links are, and what a turn of each joint moves.
//
//    root, pivot 1     pivot 2          pivot 3            r_k  link k
//        o------x------o------x---------o------x------> tip      d_ki pivot k to centre of mass i
//            r_1            r_2             r_3            s_k  pivot k to the tip
#pragma once

#include "physics/kinematics/arm_def.h"

namespace physics {

struct ArmLink {
  Vec3 length = Vec3::UnitX(), direction = Vec3::UnitX();  // link's frame; direction is unit
  double mass = 1;
  Vec3 centre = Vec3::Zero();       // of mass, from the pivot, link's frame
  Mat3 inertia = Mat3::Identity();  // about it, link's frame
  bool hinge = false;
  Vec3 axis = Vec3::UnitZ();  // parent's frame, unit
  std::array<double, 2> range{0, 0};
  double bend = 0;
};

struct ArmJoint {
  Quat turn = Quat::Identity();  // of the link in its parent's frame
  double angle = 0;              // of a hinge [rad]: turn = exp(angle axis)
};

struct Arm {
  Vec3 root = Vec3::Zero();
  Quat base = Quat::Identity();
  std::vector<ArmLink> links;
  std::vector<ArmJoint> joints;
  int size() const { return static_cast<int>(links.size()); }
};

// Throws std::invalid_argument with the link's number where a value makes no sense: no link, a link
// without length or mass, a last link that resists no turn, a start outside the limits.
Arm makeArm(const ArmDef& def);

// The arm in the world.
struct ArmPosture {
  std::vector<Quat> q;       // of each link
  std::vector<Vec3> pivot;   // of each link
  std::vector<Vec3> centre;  // of mass
  Vec3 tip = Vec3::Zero();   // root + sum of r_i                                          (149)
  Vec3 toTip(int k) const { return tip - pivot[k]; }  // s_k
};
void place(const Arm& arm, std::span<const ArmJoint> joints, ArmPosture& posture);
ArmPosture postureOf(const Arm& arm);

// The frame a joint's turn is counted in.
inline const Quat& parentOf(const Arm& arm, const ArmPosture& posture, int k) {
  return k == 0 ? arm.base : posture.q[k - 1];
}

// M_k, the inertia of all links from k on about pivot k, world frame: one pass from the tip.  (151)
void pivotInertias(const Arm& arm, const ArmPosture& posture, std::vector<Mat3>& inertia);

// ½ Δθ^T M Δθ with the whole joint-space mass matrix M, not its diagonal: the kinetic energy of the
// turns, world frame, taken as angular velocities [kg m^2 rad^2].                           (150)
double effortOf(const Arm& arm, const ArmPosture& posture, std::span<const Vec3> turns);

// From joints `a` to `b`, the turn of joint k in its parent's frame.
Vec3 turnBetween(const ArmLink& link, const ArmJoint& a, const ArmJoint& b);

}  // namespace physics
