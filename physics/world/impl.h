// What World keeps to itself.
#pragma once

#include "physics/state/world_state.h"
#include "physics/world.h"

namespace physics {

struct World::Impl : WorldState {};

}  // namespace physics
