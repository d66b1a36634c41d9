// Drive, (128)-(132).
#include "physics/constraints/drive.h"

#include "physics/constraints/motor.h"

namespace physics {

Quat Drive::aim() const {
  if (!factor.table) return target;
  const Vec3 turn = logarithm((target * start.conjugate()).normalized());
  return (exponential(factor.now * turn) * start).normalized();
}

Vec3 Drive::error(std::span<const Pose> pose) const {
  return logarithm(pose[bodies[1]].q * aim().conjugate() * pose[bodies[0]].q.conjugate());
}

void Drive::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  const double kh2 = stiffness * x.dt * x.dt, nuh = damping * x.dt;
  push.active = kh2 + nuh > 0 && maxTorque > 0;
  if (!push.active) return;
  push.c = error(x.now);
  push.f = -kh2 * push.c - nuh * turnSince(x, bodies);
  push.k = (kh2 + nuh) * Mat3::Identity();
  push.angular[0] = -Mat3::Identity();
  push.angular[1] = Mat3::Identity();
  push.longest = maxTorque * x.dt * x.dt;
}

double Drive::energy(std::span<const Pose> pose) const {
  return 0.5 * stiffness * error(pose).squaredNorm();
}

}  // namespace physics
