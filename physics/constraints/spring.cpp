// Spring and damper, (108)-(127).
#include "physics/constraints/spring.h"

namespace physics {
namespace {

Vec3 between(const Spring& spring, std::span<const Pose> pose) {
  const Pose &i = pose[spring.bodies[0]], &j = pose[spring.bodies[1]];
  return (i.x + i.q * spring.anchors[0]) - (j.x + j.q * spring.anchors[1]);
}

}  // namespace

void Spring::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const double kh2 = stiffness * x.dt * x.dt, nuh = damping * x.dt;
  const Vec3 dp = between(*this, x.now);
  const double distance = dp.norm();
  row.active = kh2 + nuh > 0 && distance > 1e-12;
  if (!row.active) return;
  const Vec3 d = dp / distance;
  row.alpha = 1 / (kh2 + nuh);
  row.c[0] = row.alpha *
             (kh2 * (distance - restLength) + nuh * (distance - between(*this, x.start).norm()));
  const Vec3 ri = x.now[bodies[0]].q * anchors[0], rj = x.now[bodies[1]].q * anchors[1];
  row.linear[0] = d.transpose();
  row.linear[1] = -d.transpose();
  row.angular[0] = ri.cross(d).transpose();
  row.angular[1] = -rj.cross(d).transpose();
}

double Spring::energy(std::span<const Pose> pose) const {
  const double stretch = between(*this, pose).norm() - restLength;
  return 0.5 * stiffness * stretch * stretch;
}

}  // namespace physics
