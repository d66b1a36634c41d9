// Drag.
#include "physics/constraints/drag.h"

namespace physics {

void Drag::evaluate(const Configuration& x, Push<kBodies, kRows>& push) const {
  push.c = x.now[bodies[0]].x - x.start[bodies[0]].x;
  const Vec3 u = push.c - x.dt * wind;  // relative speed times h
  const double size = u.norm();
  push.active = coefficient > 0;
  if (!push.active) return;
  push.f = -coefficient * size * u;
  push.k = coefficient * size * Mat3::Identity();
  if (size > 0) push.k += coefficient / size * u * u.transpose();
  push.linear[0].setIdentity();
}

}  // namespace physics
