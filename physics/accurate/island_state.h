// The state of an island, by place.
#pragma once

#include <vector>

#include "physics/base/types.h"

namespace physics {

struct IslandState {
  std::vector<Pose> pose;
  std::vector<Velocity> velocity;
};

}  // namespace physics
