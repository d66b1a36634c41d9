// A step that leaves bodies out, because they sleep or take another number of substeps: it tells
// where it meets one of them after all, and is then made anew with it.
#pragma once

#include <span>

#include "physics/collision/collider.h"
#include "physics/world.h"

namespace physics {

// By body, World::Impl::present.
enum Presence : char { kPresent, kFixed, kLeftOut };

// Looks for contacts from the start of the substep to `target`, and keeps those of what now steps.
// False: something else is met.
bool findContacts(World::Impl& world, std::span<const Pose> target);
bool findSoftContacts(World::Impl& world);

// X^t of the present substep.
std::span<const Pose> poseAtStart(const World::Impl& world);

// Takes over who is awake.
void notePresence(World::Impl& world);

// Some body that could move does not step now.
bool leavesOut(const World::Impl& world);

// Keeps what a step changes, and takes it back; only where something is left out.
void keepStart(World::Impl& world);
void takeBack(World::Impl& world);

// True: the step met what it left out, which from now on is with it.
bool includeMet(World::Impl& world, StepReport& report);

}  // namespace physics
