// A step that skips inactive bodies, because they sleep or take another number of substeps: it
// tells where it meets one of them after all, and is then made anew with it.
#pragma once

#include <span>

#include "physics/state/world_state.h"

namespace physics {

// Looks for contacts from the start of the substep to `target`, and keeps those of what now steps.
// False: something else is met.
bool findContacts(WorldState& world, std::span<const Pose> target);
bool findSoftContacts(WorldState& world);

// X^t of the present substep.
std::span<const Pose> poseAtStart(const WorldState& world);

// Some body that could move does not step now.
bool skipsInactive(const WorldState& world);

// Keeps what a step changes, and takes it back; only where something is left out.
void keepStart(WorldState& world);
void takeBack(WorldState& world);

// True: the step met what it left out, which from now on is with it.
bool includeMet(WorldState& world, StepReport& report);

}  // namespace physics
