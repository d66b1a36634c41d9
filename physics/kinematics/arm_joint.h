// Joints of an arm: how they turn, and where they stop.
#pragma once

#include "physics/kinematics/arm.h"

namespace physics {

// Turns joint k by `turn`, world frame at the pivot of `posture`; everything beyond goes with it.
// Turning all joints from the same posture gives q_k = exp(turn_0) .. exp(turn_k) q_k, as turning
// them one after the other from the tip to the root does.
void turnJoint(const Arm& arm, const ArmPosture& posture, int k, const Vec3& turn, ArmJoint& joint);

// P, the turn that a unit torque gives the joint, world frame: M^-1 for a ball, w w^T / (w . M w)
// for a hinge about w.
Mat3 mobility(const Arm& arm, const ArmPosture& posture, int k, const Mat3& inertia);

// Where the joint stands at a limit and `turn` = P * torque would take it further, takes that
// direction out of P. Returns whether it did.
bool holdAtLimit(const Arm& arm, const ArmPosture& posture, int k, const Vec3& turn, Mat3& p);

// Takes a joint that is beyond a limit back to it. Returns whether it was.
bool clampToLimit(const Arm& arm, int k, ArmJoint& joint);

}  // namespace physics
