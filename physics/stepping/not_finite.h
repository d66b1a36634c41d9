// Who is named where numbers stop being finite, and the way back to the last good state.
#pragma once

#include "physics/model/finite.h"
#include "physics/state/world_state.h"

namespace physics {

// Names the constraint or contact that pushes hardest the body that is named, where none is yet.
void nameHardest(const WorldState& w, StepReport& report);

// After a solve: names the first body with a number that is not finite, and what pushes it.
void checkSolved(const WorldState& w, StepReport& report);

// Every pose and velocity back to the start of the step, and to what they were before a velocity
// was set that is not finite. Multipliers and history are forgotten, as by setState().
void restore(WorldState& w);

}  // namespace physics
