// Arms for tests: the paper's planar one and arbitrary ones in space.
#pragma once

#include <Eigen/Dense>

#include "physics/base/rotation.h"
#include "physics/kinematics/arm_joint.h"
#include "physics/kinematics/arm_solve.h"
#include "physics/make/matter.h"

namespace physics::testing {

// Figure 10 of the paper as NOTES sets it: six thin links in the plane z = 0 with hinges, reach 1,
// every joint turned by `angle`; no regularisation, no bound on a turn: the printed iteration.
inline ArmDef planarArm(double angle = 0.05, int count = 6) {
  ArmDef def;
  for (int k = 0; k < count; ++k) {
    ArmLinkDef link;
    link.length = Vec3(1.0 / count, 0, 0);
    const double moment = 1.0 / (12 * count * count);
    link.inertia = Vec3(moment, 0, moment);
    link.hinge = true;
    link.angle = angle;
    def.links.push_back(link);
  }
  def.solve.regularisation = 0;
  def.solve.maxTurn = 2 * kPi;
  return def;
}

inline Vec3 randomVector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

// Links of any length, mass and inertia, balls and hinges in turn, somewhere, somehow turned.
inline ArmDef randomArm(Random& random, int count) {
  ArmDef def;
  def.at = randomVector(random);
  def.rotation = random.rotation(kPi);
  for (int k = 0; k < count; ++k) {
    ArmLinkDef link;
    link.length = 0.3 * Vec3::UnitY() + 0.2 * randomVector(random);
    link.mass = random.uniform(0.5, 2);
    link.centre = 0.4 * link.length + 0.05 * randomVector(random);
    link.inertia = Vec3(0.02, 0.015, 0.03) * random.uniform(0.5, 2);
    link.hinge = k % 2 == 1;
    link.axis = randomVector(random);
    link.angle = random.uniform(-1.2, 1.2);
    def.links.push_back(link);
  }
  return def;
}

// The tip after everything beyond pivot k has turned by `turn`, world frame.
inline Vec3 tipAfter(const ArmPosture& posture, int k, const Vec3& turn) {
  return posture.pivot[k] + exponential(turn) * posture.toTip(k);
}

inline std::vector<Mat3> mobilities(const Arm& arm, const ArmPosture& posture) {
  std::vector<Mat3> inertia;
  pivotInertias(arm, posture, inertia);
  for (int k = 0; k < arm.size(); ++k) inertia[k] = mobility(arm, posture, k, inertia[k]);
  return inertia;
}

inline double errorOf(const Arm& arm, const Vec3& target) {
  return (postureOf(arm).tip - target).norm();
}

// Iterates until the tip is within `near` of the target; the number of iterations, `most` at the
// most.
inline int reach(Arm& arm, const Vec3& target, const ArmSolve& solve, int most, double near) {
  ArmScratch scratch;
  int count = 0;
  while (count < most && errorOf(arm, target) >= near) {
    iterate(arm, target, solve, scratch);
    ++count;
  }
  return count;
}

}  // namespace physics::testing
