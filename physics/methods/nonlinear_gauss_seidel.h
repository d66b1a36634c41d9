// Non-linear Gauss-Seidel (52),(53): every constraint in turn, its error taken at the latest
// displacement.
#pragma once

#include "physics/world_impl.h"

namespace physics {

// First guess: the multipliers of the last substep, or zero where the World does not warm start.
void prepareConstraints(World::Impl& world, double dt);

// Sweeps `settings.iterations` times. On the first change that is not finite the sweep stops, and
// report.notFinite names it.
void nonlinearGaussSeidel(World::Impl& world, double dt, StepReport& report);

}  // namespace physics
