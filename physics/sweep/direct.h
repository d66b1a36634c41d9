// The direct method (42): all joints of the world at once, a Newton step per iteration; springs,
// drives and contacts by a Gauss-Seidel sweep between the steps.
//
// What is solved is backward Euler with directions at the end of the step, M dX = J(X)^T lambda,
// c(X) = 0:
//   (M + K) ddX - J^T dlambda = J^T lambda - M dX,   J ddX = -c
// K is the geometric stiffness -d(J^T lambda)/dX, its part that stiffens: a link under tension
// resists being turned. Without it Newton's steps overshoot as soon as the tension rings a link
// faster than the step.
#pragma once

#include "physics/sweep/sweep_model.h"

namespace physics {

// Start of a substep.
void prepareDirect(SweepModel& world);

void direct(SweepModel& world, double dt, StepReport& report);

// Velocities at the end of the symmetric scheme: J v = 0 for every joint.
void projectJoints(SweepModel& world);

// Names a joint where the system of all broke down: the furthest off, first of all one that is not
// finite.
void nameWorstJoint(const SweepModel& world, StepReport& report);

}  // namespace physics
