// Bend.
#include "physics/constraints/bend.h"

namespace physics {
namespace {

Vec3 curvature(std::span<const Pose> pose, const std::array<BodyId, 3>& bodies) {
  return pose[bodies[0]].x - 2 * pose[bodies[1]].x + pose[bodies[2]].x;
}

}  // namespace

void Bend::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  const double kh2 = stiffness * x.dt * x.dt, nuh = damping * x.dt;
  push.active = kh2 + nuh > 0;
  if (!push.active) return;
  push.c = curvature(x.now, bodies);
  push.f = -kh2 * push.c - nuh * (push.c - curvature(x.start, bodies));
  push.k = (kh2 + nuh) * Mat3::Identity();
  push.linear = {Mat3::Identity(), -2 * Mat3::Identity(), Mat3::Identity()};
}

double Bend::energy(std::span<const Pose> pose) const {
  return 0.5 * stiffness * curvature(pose, bodies).squaredNorm();
}

}  // namespace physics
