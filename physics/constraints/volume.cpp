// Volume, (140)-(142).
#include "physics/constraints/volume.h"

#include <cmath>

namespace physics {

double volumeOf(const std::array<Vec3, 4>& x) {
  return (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0])) / 6;
}

void Volume::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Vec3& x0 = x.now[bodies[0]].x;
  const Vec3 d1 = x.now[bodies[1]].x - x0, d2 = x.now[bodies[2]].x - x0,
             d3 = x.now[bodies[3]].x - x0;
  const Vec3 a1 = d2.cross(d3), a2 = d3.cross(d1), a3 = d1.cross(d2);  // 2 A_i
  row.c[0] = d1.dot(a1) - 6 * volume;                                  // (140)
  row.linear = {-(a1 + a2 + a3).transpose(), a1.transpose(), a2.transpose(), a3.transpose()};
  row.alpha = compliance / (x.dt * x.dt);
}

double Volume::errorPerMetre() const { return 6 * std::cbrt(volume * volume); }

double Volume::relativeError(std::span<const Pose> pose) const {
  const double now =
      volumeOf({pose[bodies[0]].x, pose[bodies[1]].x, pose[bodies[2]].x, pose[bodies[3]].x});
  return std::abs(now / volume - 1);
}

}  // namespace physics
