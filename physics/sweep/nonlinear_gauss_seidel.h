// Non-linear Gauss-Seidel (52),(53): every constraint in turn, its error taken at the latest
// displacement, N sweeps to a substep.
#pragma once

#include "physics/model/finite.h"
#include "physics/sweep/sweep_model.h"

namespace physics {

// Inverse inertia at the present poses: of M, or of M~ where the World asks for it.
void refreshInverseMasses(SweepModel& world, double dt);

// Between two sweeps, where inertia follows the turn of every iteration (4.1).
void refreshIterate(SweepModel& world, double dt);

// Start of a substep: gaps and anchors at X^t, lambda = 0; the direct method's go on from the last.
void prepareConstraints(SweepModel& world, double dt);

// One sweep over everything; rows that the direct method solves are left out.
// False: some change was not finite, and report.notFinite names it.
bool sweep(SweepModel& world, double dt, StepReport& report);

void nonlinearGaussSeidel(SweepModel& world, double dt, StepReport& report);  // (52)
void linearGaussSeidel(SweepModel& world, double dt, StepReport& report);     // (51)

}  // namespace physics
