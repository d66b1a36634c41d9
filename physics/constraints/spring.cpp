// Spring and damper, (108)-(127).
#include "physics/constraints/spring.h"

#include "physics/constraints/between.h"

namespace physics {

void Spring::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  const double kh2 = stiffness * x.dt * x.dt, nuh = damping * x.dt;
  const Vec3 dp = between(x.now, bodies, anchors);
  const double distance = dp.norm();
  push.active = kh2 + nuh > 0 && distance > kCoincident;
  if (!push.active) return;
  push.c[0] = distance;
  push.f[0] = -kh2 * (distance - restLength);
  if (nuh > 0) {
    push.f[0] -= nuh * changeSinceStart(x, [&](std::span<const Pose> pose) {
                   return between(pose, bodies, anchors).norm();
                 });
  }
  push.k(0, 0) = kh2 + nuh;
  gradientAlong(dp / distance, x.now, bodies, anchors, push);
}

double Spring::energy(std::span<const Pose> pose) const {
  const double stretch = between(pose, bodies, anchors).norm() - restLength;
  return 0.5 * stiffness * stretch * stretch;
}

void VectorSpring::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  const double kh2 = stiffness * x.dt * x.dt, nuh = damping * x.dt;
  push.active = kh2 + nuh > 0;
  if (!push.active) return;
  push.c = between(x.now, bodies, anchors);
  push.f = -kh2 * push.c;
  if (nuh > 0) {
    push.f -= nuh * changeSinceStart(x, [&](std::span<const Pose> pose) -> Vec3 {
                return between(pose, bodies, anchors);
              });
  }
  push.k = (kh2 + nuh) * Mat3::Identity();
  gradientOfGap(x.now, bodies, anchors, push);
}

double VectorSpring::energy(std::span<const Pose> pose) const {
  return 0.5 * stiffness * between(pose, bodies, anchors).squaredNorm();
}

}  // namespace physics
