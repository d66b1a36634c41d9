// Non-linear Gauss-Seidel (52),(53): every constraint in turn, its error taken at the latest
// displacement.
#pragma once

#include "physics/world_impl.h"

namespace physics {

// First guess: the multipliers of the last substep, or zero where the World does not warm start.
void prepareConstraints(World::Impl& world, double dt);

// One sweep over everything; equalities are left out where the direct method solves them.
// False: some change was not finite, and report.notFinite names it.
bool sweep(World::Impl& world, double dt, StepReport& report);

// Sweeps `settings.iterations` times. On the first change that is not finite the sweep stops, and
// report.notFinite names it.
void nonlinearGaussSeidel(World::Impl& world, double dt, StepReport& report);

}  // namespace physics
