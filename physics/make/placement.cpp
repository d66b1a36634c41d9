// Lattices of poses.
#include "physics/make/placement.h"

#include <cmath>

namespace physics {

void requireCount(double bodies) {
  require(bodies <= kMostBodies, "expected at most " + std::to_string(kMostBodies) +
                                     " bodies, got " + std::to_string(std::llround(bodies)));
}

std::vector<Pose> latticePoses(const Lattice& lattice, const Vec3& spacing, std::uint64_t seed) {
  const auto& n = lattice.counts;
  requireCount(static_cast<double>(n[0]) * n[1] * n[2]);
  const Vec3 step = lattice.spacing.value_or(spacing);
  Random random(seed);
  std::vector<Pose> poses;
  for (int y = 0; y < n[1]; ++y) {
    for (int z = 0; z < n[2]; ++z) {
      for (int x = 0; x < n[0]; ++x) {
        const Vec3 place(x - 0.5 * (n[0] - 1), y, z - 0.5 * (n[2] - 1));
        Pose pose;
        pose.x = place.cwiseProduct(step);
        if (lattice.jitter > 0) pose.x += random.inBall(lattice.jitter);
        if (lattice.turn > 0) pose.q = random.rotation(lattice.turn);
        poses.push_back(pose);
      }
    }
  }
  return poses;
}

}  // namespace physics
