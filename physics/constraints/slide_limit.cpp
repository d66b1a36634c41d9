// Slide limit.
#include "physics/constraints/slide_limit.h"

namespace physics {

void SlideLimit::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Pose &i = x.now[bodies[0]], &j = x.now[bodies[1]];
  const Vec3 armJ = j.q * anchors[1], armI = j.x + armJ - i.x, n = i.q * axisI;
  const double s = n.dot(armI - i.q * anchors[0]);
  row.linear[0] = -n.transpose();
  row.linear[1] = n.transpose();
  row.angular[0] = -armI.cross(n).transpose();
  row.angular[1] = armJ.cross(n).transpose();
  const bool nearHigh = s - low > high - s;
  row.c[0] = nearHigh ? s - high : s - low;
  (nearHigh ? row.high : row.low) = 0;
}

}  // namespace physics
