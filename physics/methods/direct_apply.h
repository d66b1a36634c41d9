// What a Newton step of the direct method does to the bodies.
#pragma once

#include "physics/world_impl.h"

namespace physics {

// From World::Impl::jointChange, the change of every joint's multipliers.
void applyNewtonStep(World::Impl& world);

// By the same factor: what contacts have corrected is followed, without speed.
void followCorrections(World::Impl& world);

}  // namespace physics
