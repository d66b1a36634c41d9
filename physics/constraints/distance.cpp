// Distance, (133)-(135).
#include "physics/constraints/distance.h"

namespace physics {

void Distance::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Pose &i = x.now[bodies[0]], &j = x.now[bodies[1]];
  const Vec3 ri = i.q * anchors[0], rj = j.q * anchors[1];
  const Vec3 dp = (i.x + ri) - (j.x + rj);
  const double distance = dp.norm();
  const Vec3 d = distance > 1e-12 ? Vec3(dp / distance) : Vec3::UnitY();
  row.c[0] = distance - length;
  row.linear[0] = d.transpose();
  row.linear[1] = -d.transpose();
  row.angular[0] = ri.cross(d).transpose();
  row.angular[1] = -rj.cross(d).transpose();
  if (rope) row.high = 0;  // pulls only
}

}  // namespace physics
