// Who is named where numbers stop being finite, and the way back to the last good state.
#pragma once

#include "physics/world_impl.h"

namespace physics {

// Names the first body whose pose, velocity or load is not finite, one that moves before any other.
void checkFinite(const World::Impl& w, StepReport& report);

// The same after a solve that named nobody, with the constraint or contact of that body that pushes
// hardest.
void checkSolved(const World::Impl& w, StepReport& report);

// Every pose and velocity back to the start of the step, and to what they were before a velocity
// was set that is not finite. Multipliers and history are forgotten, as by setState().
void restore(World::Impl& w);

}  // namespace physics
