// Algorithm 1 of the paper: a substep by the sweeps of its methods, or by a rival in their place.
#pragma once

#include "physics/state/world_state.h"

namespace physics {

// The substeps of what now steps, from the present state to the end of the step. They end early
// where a number is not finite, or where they meet what does not step with them.
void substeps(WorldState& world, StepReport& report);

// False: the step ends here.
bool goesOn(const WorldState& world, const StepReport& report);

}  // namespace physics
