// Energy, momenta and the state hash of a World.
#pragma once

#include <cstdint>

#include "physics/world.h"

namespace physics {

struct Measures {
  double kinetic = 0, potential = 0;    // J; potential: gravity about the origin, and springs
  Vec3 linearMomentum = Vec3::Zero();   // kg m/s, dynamic bodies
  Vec3 angularMomentum = Vec3::Zero();  // about the origin [kg m^2/s]
  double total() const { return kinetic + potential; }
};
Measures measure(const World& world);

// 64-bit hash of every pose and velocity, bit for bit, of who sleeps, and of the step count.
std::uint64_t stateHash(const World& world);

}  // namespace physics
