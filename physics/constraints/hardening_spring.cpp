// Hardening spring.
#include "physics/constraints/hardening_spring.h"

#include "physics/constraints/between.h"

namespace physics {

void HardeningSpring::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  const double h2 = x.dt * x.dt, nuh = damping * x.dt;
  const Vec3 dp = between(x.now, bodies, anchors);
  const double distance = dp.norm(), s = distance - restLength;
  push.active = stiffness + cubic + damping > 0 && distance > kCoincident;
  if (!push.active) return;
  push.c[0] = distance;
  push.f[0] = -h2 * (stiffness * s + cubic * s * s * s);
  if (nuh > 0) {
    push.f[0] -= nuh * changeSinceStart(x, [&](std::span<const Pose> pose) {
                   return between(pose, bodies, anchors).norm();
                 });
  }
  push.k(0, 0) = h2 * (stiffness + 3 * cubic * s * s) + nuh;
  gradientAlong(dp / distance, x.now, bodies, anchors, push);
}

double HardeningSpring::energy(std::span<const Pose> pose) const {
  const double s = between(pose, bodies, anchors).norm() - restLength, s2 = s * s;
  return 0.5 * stiffness * s2 + 0.25 * cubic * s2 * s2;
}

}  // namespace physics
