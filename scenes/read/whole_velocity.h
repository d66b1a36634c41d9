// velocity and angular_velocity of what a generator makes: that of the whole, about its centre of
// mass.
#pragma once

#include "physics/world.h"
#include "scenes/read/table_reader.h"

namespace scenes {

struct WholeVelocity {
  std::optional<physics::Vec3> v, w;  // m/s, rad/s

  void read(TableReader& reader);
  // Added to what its moving bodies have already.
  void give(physics::World& world, std::span<const physics::BodyId> bodies) const;
};

}  // namespace scenes
