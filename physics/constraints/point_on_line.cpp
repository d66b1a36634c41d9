// Point on a line.
#include "physics/constraints/point_on_line.h"

namespace physics {

void PointOnLine::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Pose &i = x.now[bodies[0]], &j = x.now[bodies[1]];
  const Vec3 armJ = j.q * anchors[1], point = j.x + armJ, armI = point - i.x;
  const Vec3 d = armI - i.q * anchors[0];
  for (int k = 0; k < kRows; ++k) {
    const Vec3 normal = i.q * frameI.col(k);
    row.c[k] = normal.dot(d);
    row.linear[0].row(k) = -normal.transpose();
    row.linear[1].row(k) = normal.transpose();
    row.angular[0].row(k) = -armI.cross(normal).transpose();
    row.angular[1].row(k) = armJ.cross(normal).transpose();
  }
}

}  // namespace physics
