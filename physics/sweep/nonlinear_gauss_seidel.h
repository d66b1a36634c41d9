// Non-linear Gauss-Seidel (52),(53): every constraint in turn, its error taken at the latest
// displacement.
#pragma once

#include <functional>

#include "physics/model/finite.h"
#include "physics/sweep/sweep_model.h"

namespace physics {

// Nothing that steps is joined or pushed by a constraint or a force.
bool onlyContacts(const SweepModel& world);

// Inverse inertia at the present poses: of M, or of M~ where the World asks for it.
void refreshInverseMasses(SweepModel& world, double dt);

// First guess: the multipliers of the last substep, or zero where the World does not warm start.
void prepareConstraints(SweepModel& world, double dt);

// One sweep over everything; equalities are left out where the direct method solves them.
// False: some change was not finite, and report.notFinite names it.
bool sweep(SweepModel& world, double dt, bool backward, StepReport& report);

// Velocities on J v = 0 at the end of the symmetric scheme: the direct method's joints at once, the
// others in sweeps.
void projectVelocities(SweepModel& world);

// Sweeps settings.iterations times, and on while contacts move by more than settings.tolerance in a
// sweep, settings.maxIterations at the most. `beforeSweep`, where given, may end it by returning
// false.
void iterate(SweepModel& world, double dt, StepReport& report,
             const std::function<bool()>& beforeSweep);

void nonlinearGaussSeidel(SweepModel& world, double dt, StepReport& report);  // (52)
void linearGaussSeidel(SweepModel& world, double dt, StepReport& report);     // (51)

}  // namespace physics
