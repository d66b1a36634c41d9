// Inverse kinematics of an arm: (149)-(154), one scalar constraint on the distance of tip and
// target.
//   c = |tip - target|  [m]    dc/dtheta_k = s_k x n,  n = (tip - target) / c (152) tip at the
//   target: nothing to do, no direction needed; gradient zero: see `bendAside`.
#pragma once

#include "physics/kinematics/arm.h"

namespace physics {

// (149) with the root, which the paper leaves out: c = 0 at the target for any root. paper.md
struct TipError {
  double c = 0;           // m
  Vec3 n = Vec3::Zero();  // unit; zero where c is
};
TipError tipError(const ArmPosture& posture, const Vec3& target);

// dc/dtheta_k for a turn in the world frame of everything beyond pivot k. (152)
inline Vec3 gradientOf(const ArmPosture& posture, int k, const Vec3& n) {
  return posture.toTip(k).cross(n);
}

// J M^-1 J^T, the sum over the joints of (s x n) . P (s x n): (153) without its sign error.
double inverseMass(const ArmPosture& posture, std::span<const Mat3> mobility, const Vec3& n);

// The mean of it over all directions n: what alpha is a multiple of. NOTES 3.10 takes the trace of
// M^-1 times |s|^2 instead, which a thin link makes as large as its own twist is easy; here
// turns about s, which do not move the tip, count for nothing.
double meanInverseMass(const ArmPosture& posture, std::span<const Mat3> mobility);

// What an iteration works with; no allocation after the first.
struct ArmScratch {
  ArmPosture now, tried;
  std::vector<Mat3> inertia, mobility;
  std::vector<ArmJoint> before;
  std::vector<Vec3> turns;
};

struct ArmIteration {
  double error = 0;   // before it [m]
  double lambda = 0;  // the change of the multiplier [kg m, or m for the pseudo-inverse]
  double effort = 0;  // ½ Δθ^T M Δθ of what it did [kg m^2 rad^2]
  int held = 0;       // joints at a limit that would have gone further
  bool bent = false;  // had no gradient and was bent aside
  bool moved = false;
};

// One iteration of (154). alpha is in mu only, so that the target is reached exactly, and it grows
// (Levenberg, Marquardt) where the step would not bring the half of what it promises: a target
// out of reach is approached as near as can be and left so. With regularisation zero every step is
// taken as it is.
ArmIteration iterate(Arm& arm, const Vec3& target, const ArmSolve& solve, ArmScratch& scratch);

// Bends joints a little where the gradient is zero but the target is not reached, as in a straight
// chain along the error: first each joint by kBend one way and the other, from the tip to the root,
// then neighbours against each other so that the tip stays on its line. A ball bends about a normal
// to n. The first bend that brings the tip nearer is kept; where none does, this is a minimum.
bool bendAside(Arm& arm, const Vec3& target, const TipError& error, ArmScratch& scratch);

}  // namespace physics
