// Panel drag.
#include "physics/constraints/panel_drag.h"

namespace physics {

void PanelDrag::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  const Vec3 &p0 = x.now[bodies[0]].x, &p1 = x.now[bodies[1]].x, &p2 = x.now[bodies[2]].x;
  const Vec3 doubled = (p1 - p0).cross(p2 - p0);
  const double size = doubled.norm();
  push.active = coefficient > 0 && size > 1e-300;
  if (!push.active) return;
  const Vec3 n = doubled / size;
  push.c = (p0 + p1 + p2 - x.start[bodies[0]].x - x.start[bodies[1]].x - x.start[bodies[2]].x) / 3;
  const double u = n.dot(push.c - x.dt * wind), beta = 0.5 * size * coefficient;
  push.f = -beta * std::abs(u) * u * n;
  push.k = 2 * beta * std::abs(u) * n * n.transpose();
  for (auto& linear : push.linear) linear = Mat3::Identity() / 3;
}

}  // namespace physics
