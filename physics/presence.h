// A step that skips inactive bodies, because they sleep or take another number of substeps: it
// tells where it meets one of them after all, and is then made anew with it.
#pragma once

#include <span>

#include "physics/world_impl.h"

namespace physics {

// Looks for contacts from the start of the substep to `target`, and keeps those of what now steps.
// False: something else is met.
bool findContacts(World::Impl& world, std::span<const Pose> target);
bool findSoftContacts(World::Impl& world);

// X^t of the present substep.
std::span<const Pose> poseAtStart(const World::Impl& world);

// Some body that could move does not step now.
bool skipsInactive(const World::Impl& world);

// Keeps what a step changes, and takes it back; only where something is left out.
void keepStart(World::Impl& world);
void takeBack(World::Impl& world);

// True: the step met what it left out, which from now on is with it.
bool includeMet(World::Impl& world, StepReport& report);

}  // namespace physics
