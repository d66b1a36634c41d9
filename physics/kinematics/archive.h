// What steps change of an arm.
#pragma once

#include "physics/base/archive.h"
#include "physics/kinematics/driven_arm.h"

namespace physics {

inline void archive(Archive& a, ArmJoint& joint) {
  auto& [turn, angle] = joint;
  a(turn, angle);
}

inline void archive(Archive& a, DrivenArm& driven) {
  auto& [arm, solve, maxSpeed, bodies, target, followed, start, effort, iterations, held, before,
         scratch] = driven;
  auto& [joints, followedBefore, effortBefore] = before;
  a(arm.joints, target, followed, effort, iterations, held, joints, followedBefore, effortBefore);
}

}  // namespace physics
