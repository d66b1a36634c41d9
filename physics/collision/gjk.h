// Distance between two convex cores: Gilbert, Johnson and Keerthi.
#pragma once

#include "physics/collision/solid.h"

namespace physics::collision {

// Closest points of the cores, in b's frame. `overlap`: the cores meet, or are closer than rounding
// lets a direction be told (1e-9 of their sizes); the points are then meaningless.
struct Distance {
  double distance = 0;
  Vec3 onA = Vec3::Zero(), onB = Vec3::Zero();
  bool overlap = false;
};
Distance coreDistance(const Solid& a, const Solid& b, const Relative& pose);

}  // namespace physics::collision
