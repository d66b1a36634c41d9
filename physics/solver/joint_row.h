// One constraint or force at a pose, whatever its kind, as an articulation takes it.
#pragma once

#include <array>

#include "physics/base/inverse.h"
#include "physics/constraints/kinds.h"
#include "physics/solver/joint_block.h"

namespace physics {

struct JointRow {
  static constexpr int kMostBodies = 2, kMostRows = 3;
  enum class Role : char { kConstraint, kForce, kLoad };  // a load does not change with X
  Role role = Role::kConstraint;
  bool active = true;                     // it has anything to say at this pose
  double low = 0, high = 0, longest = 0;  // bounds of the total
  Vec3 c = Vec3::Zero();
  Mat3 alpha = Mat3::Zero();
  std::array<Mat3, kMostBodies> linear, angular;  // J, by rows
  std::array<Vec3, kMostBodies> arm;              // world, where it pulls
};

// K^-1 of a push that falls off in some directions only: in the others as stiff as this part of its
// mean.
template <typename Matrix>
Matrix complianceOf(const Matrix& stiffness) {
  constexpr double kLeastStiffness = 1e-7;
  Matrix even = 0.5 * (stiffness + stiffness.transpose());
  even.diagonal().array() += kLeastStiffness * stiffness.diagonal().mean();
  return inverseOrNan(even);
}

// Before it is evaluated: rows of J that a kind does not have are left as they are.
inline void clear(JointRow& row) {
  row.c.setZero();
  for (int b = 0; b < JointRow::kMostBodies; ++b) {
    row.linear[b].setZero();
    row.angular[b].setZero();
    row.arm[b].setZero();
  }
}

// What is the same at every pose.
struct JointKind {
  int bodyCount = 0, rows = 0;
  std::array<BodyId, JointRow::kMostBodies> bodies{};
  JointSeen seen = JointSeen::kByKind;
  std::array<double, kJointFixed> fixed{};  // of what the kernels evaluate
  bool hasLinear = false, hasAngular = false;
  bool pulls = false;  // it has anchors, and so geometric stiffness
  bool isForce = false;
  bool stands = true;  // what it wants is a place, not a speed: a motor wants a speed
  double regularisation = 0;
};

struct JointRef {
  int kind, item;  // in Kinds, in its set
};

// Equality: it holds whatever it takes. One-sided: a limit. Other: of velocities, or of more
// bodies.
enum class Nature : char { kEquality, kOneSided, kForce, kOther };
Nature natureOf(const Kinds& kinds, JointRef ref);

JointKind kindOf(const Kinds& kinds, JointRef ref);
void evaluateRow(const Kinds& kinds, JointRef ref, const Configuration& at, JointRow& row);
// Of a step of dt; rows that a kind does not have are zero.
struct Multiplier {
  Vec3 total = Vec3::Zero();
  double dt = 0;
};
Multiplier readMultiplier(const Kinds& kinds, JointRef ref);
void writeMultiplier(Kinds& kinds, JointRef ref, const Vec3& lambda, double dt);
bool carries(const Kinds& kinds, JointRef ref);  // it did when it was solved last

}  // namespace physics
