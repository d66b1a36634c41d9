// Drive, (128)-(132).
#include "physics/constraints/drive.h"

namespace physics {

Vec3 Drive::error(std::span<const Pose> pose) const {
  return logarithm(pose[bodies[1]].q * target.conjugate() * pose[bodies[0]].q.conjugate());
}

void Drive::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const double kh2 = stiffness * x.dt * x.dt, nuh = damping * x.dt;
  row.active = kh2 + nuh > 0 && maxTorque > 0;
  if (!row.active) return;
  row.alpha = 1 / (kh2 + nuh);
  const Vec3 turned = logarithm(x.now[bodies[1]].q * x.start[bodies[1]].q.conjugate()) -
                      logarithm(x.now[bodies[0]].q * x.start[bodies[0]].q.conjugate());
  row.c = row.alpha * (kh2 * error(x.now) + nuh * turned);
  row.angular[0] = -Mat3::Identity();
  row.angular[1] = Mat3::Identity();
  row.longest = maxTorque * x.dt * x.dt;
}

}  // namespace physics
