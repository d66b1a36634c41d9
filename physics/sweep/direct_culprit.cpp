// The direct method: who is named where it breaks down.
#include <cmath>

#include "physics/constraints/constraint_solve.h"
#include "physics/sweep/direct.h"
#include "physics/sweep/nonlinear_gauss_seidel.h"

namespace physics {

void nameWorstJoint(const SweepModel& world, StepReport& report) {
  std::size_t next = 0;
  double most = -1;
  forEachKind(world.kinds, [&](const auto& kind) {
    using K = std::decay_t<decltype(kind)>;
    if constexpr (!Force<typename K::Item> && K::Item::kBodies == 2) {
      for (std::size_t k = 0; k < kind.set.items.size(); ++k) {
        if (!isSolvedDirectly(kind.set.items[k])) continue;
        const JointRows& joint = world.jointRows[next];
        const double size = joint.right.norm() + world.jointChange[next++].norm();
        if (!std::isfinite(most) || size <= most) continue;
        most = size;
        nameCulprit(report, K::kWord, k, moverOf(kind.set.items[k], world.bodies));
      }
    }
  });
}

}  // namespace physics
