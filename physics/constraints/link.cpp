// Link, (133)-(135).
#include "physics/constraints/link.h"

#include "physics/constraints/between.h"

namespace physics {

void Link::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Vec3 dp = x.now[bodies[0]].x - x.now[bodies[1]].x;
  const double distance = dp.norm();
  row.c[0] = distance - length;
  const Vec3 d = distance > kCoincident
                     ? Vec3(dp / distance)
                     : startDirection(x.start[bodies[0]].x - x.start[bodies[1]].x);
  row.linear[0] = d.transpose();
  row.linear[1] = -d.transpose();
  row.alpha = compliance / (x.dt * x.dt);
  if (rope) row.high = 0;  // pulls only
}

}  // namespace physics
