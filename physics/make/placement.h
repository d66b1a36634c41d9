// Where a generator's bodies stand: a pose for the whole, and copies on a lattice.
#pragma once

#include "physics/make/matter.h"

namespace physics {

// The generator builds about its own origin, y up; this puts it into the world.
struct Placement {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"position", Unit::kPoint}, d.position);
    v(Field{"rotation"}, d.rotation);
  }
  Pose operator()(const Pose& local) const {
    return {position + rotation * local.x, (rotation * local.q).normalized()};
  }
};

// Copies on a lattice centred on its bottom layer, each moved and turned at random where asked.
struct Lattice {
  std::array<int, 3> counts{1, 1, 1};  // along x, y, z
  std::optional<Vec3> spacing;         // m, centre to centre
  double jitter = 0;                   // m, radius of the random shift
  double turn = 0;                     // rad, largest random turn
  template <class V, class D>
  static void fields(V& v, D& d) {
    v(Field{"counts", Unit::kNone, false, 1, kMostBodies}, d.counts);
    v(Field{"spacing", Unit::kMetre, false, kMorePositive}, d.spacing);
    v(Field{"jitter", Unit::kMetre, false, 0}, d.jitter);
    v(Field{"turn_degrees", Unit::kDegrees, false, 0, 180}, d.turn);
  }
};

// The lattice's poses, layer by layer from below; `spacing` where the lattice has none of its own.
std::vector<Pose> latticePoses(const Lattice& lattice, const Vec3& spacing, std::uint64_t seed);

// Throws where a generator would make more bodies than it may.
void requireCount(double bodies);

}  // namespace physics
