// Perpendicular.
#include "physics/constraints/perpendicular.h"

namespace physics {

void Perpendicular::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const AngleBetween between =
      angleBetween(x.now[bodies[0]].q * axes[0], x.now[bodies[1]].q * axes[1]);
  row.c[0] = between.phi - 0.5 * kPi;
  row.angular[0] = -between.w.transpose();
  row.angular[1] = between.w.transpose();
}

}  // namespace physics
