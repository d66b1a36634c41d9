// An arm whose links are kinematic bodies of a World: solved before each step, carried by it.
#pragma once

#include "physics/kinematics/arm_report.h"
#include "physics/kinematics/arm_solve.h"

namespace physics {

struct DrivenArm {
  Arm arm;
  ArmSolve solve;
  double maxSpeed = 0;         // of `followed` [m/s]
  std::vector<BodyId> bodies;  // one per link
  Vec3 target = Vec3::Zero();
  Vec3 followed = Vec3::Zero();  // goes to the target no faster than maxSpeed
  std::vector<ArmJoint> start;   // joints before the first step
  double effort = 0;             // sum of ½ Δθ^T M Δθ over all iterations so far
  int iterations = 0, held = 0;  // of the last step
  struct {                       // the state before the last step
    std::vector<ArmJoint> joints;
    Vec3 followed = Vec3::Zero();
    double effort = 0;
  } before;
  ArmScratch scratch;
};

// The arm without its bodies.
DrivenArm makeDriven(const ArmDef& def);

// Link k as a kinematic body: a capsule from its pivot to the next.
BodyDef linkBody(const ArmDef& def, const DrivenArm& driven, int k);

// Where link k's body is: its origin in the middle of the link, y along it.
Pose linkPose(const Arm& arm, const ArmPosture& posture, int k);

// Solves each arm towards its target and gives its bodies the velocities that take them to the new
// posture in `dt` exactly, each by a constant velocity and turn. `accuracy`: as many iterations as
// bring the tip so near, of the arm's length, instead of those that it has; fewer where they do not
// bring it nearer.
void drive(std::vector<DrivenArm>& arms, Bodies& bodies, double dt,
           std::optional<double> accuracy = {});

// Takes the last `drive` back.
void undo(std::vector<DrivenArm>& arms);

ArmReport report(const DrivenArm& driven);

}  // namespace physics
