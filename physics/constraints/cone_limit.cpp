// Cone limit, (88)-(90).
#include "physics/constraints/cone_limit.h"

namespace physics {

void ConeLimit::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Vec3 ni = x.now[bodies[0]].q * axes[0], nj = x.now[bodies[1]].q * axes[1];
  const AngleBetween between = angleBetween(ni, nj);
  row.c[0] = between.phi - angle;
  // (81) with both signs turned: turning i about w closes the angle. paper.md
  row.angular[0] = -between.w.transpose();
  row.angular[1] = between.w.transpose();
  row.high = 0;  // pushes only inwards, (90) on the total
}

}  // namespace physics
