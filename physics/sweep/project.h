// The end of a substep of the symmetric scheme (RATTLE): velocities on J v = 0.
#pragma once

#include "physics/sweep/sweep_model.h"

namespace physics {

// The direct method's joints at once, the others in sweeps.
void projectVelocities(SweepModel& world);

}  // namespace physics
