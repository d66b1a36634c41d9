// Velocities on J v = 0.
#include "physics/sweep/project.h"

#include <algorithm>

#include "physics/constraints/constraint_symmetric.h"
#include "physics/motion/free_motion.h"
#include "physics/sweep/direct.h"

namespace physics {
namespace {

constexpr double kProjected = 1e-10;  // rates of equalities that are left [m/s, rad/s]
constexpr int kMostSweeps = 40;

template <class C>
double projectKind(Set<C>& set, SweepModel& world, bool isDirect) {
  double change = 0;
  if constexpr (!Force<C> && canStand<C>()) {
    for (const int k : set.active) {
      if (isDirect && isSolvedDirectly(set.items[k])) continue;
      if (!isSymmetric(set.items[k], world.bodies)) continue;
      Scratch<C> local;
      Scratch<C>& scratch = C::kBodies == kMany ? set.scratch : local;
      change = std::max(change, projectVelocity(set.items[k], world.bodies, scratch));
    }
  }
  return change;
}

}  // namespace

void projectVelocities(SweepModel& world) {
  const std::vector<Scheme>& scheme = world.bodies.second.scheme;
  if (std::find(scheme.begin(), scheme.end(), Scheme::kSymmetric) == scheme.end()) return;
  refreshInertia(world.bodies);
  const bool isDirect = world.settings.method == Method::kDirect;
  double change = 1;
  for (int k = 0; k < kMostSweeps && change > kProjected; ++k) {
    if (isDirect) projectJoints(world);
    change = 0;
    forEachKind(world.kinds, [&](auto& kind) {
      change = std::max(change, projectKind(kind.set, world, isDirect));
    });
  }
}

}  // namespace physics
