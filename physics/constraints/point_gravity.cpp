// Point gravity.
#include "physics/constraints/point_gravity.h"

#include "physics/constraints/between.h"

namespace physics {

void PointGravity::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  push.c = x.now[bodies[0]].x - x.now[bodies[1]].x;
  const double r2 = push.c.squaredNorm(), rho2 = r2 + softening * softening;
  push.active = strength > 0 && rho2 > kCoincident * kCoincident;
  if (!push.active) return;
  const double pull = strength * x.dt * x.dt / (rho2 * std::sqrt(rho2));
  push.f = -pull * push.c;
  push.k = pull * Mat3::Identity();
  if (r2 > 0) push.k -= pull / r2 * push.c * push.c.transpose();
  push.linear[0].setIdentity();
  push.linear[1] = -Mat3::Identity();
}

double PointGravity::energy(std::span<const Pose> pose) const {
  const double r2 = (pose[bodies[0]].x - pose[bodies[1]].x).squaredNorm();
  const double rho = std::sqrt(r2 + softening * softening);
  return rho > kCoincident ? -strength / rho : 0;
}

}  // namespace physics
