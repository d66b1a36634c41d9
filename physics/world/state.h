// States that come from elsewhere.
#pragma once

#include <span>

#include "physics/bodies/body.h"

namespace physics {

// The first body that World::setState() refuses a state for: a number of it is not finite, or its
// quaternion is zero. -1: none.
BodyId firstNotFinite(std::span<const Pose> poses, std::span<const Velocity> velocities);

}  // namespace physics
