// Rope length, (136)-(139).
#include "physics/constraints/rope_length.h"

#include "physics/constraints/between.h"

namespace physics {

void RopeLength::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  row.linear.resize(bodies.size());
  row.linear[0].setZero();
  double sum = 0;
  for (std::size_t i = 0; i + 1 < bodies.size(); ++i) {
    const Vec3 dp = x.now[bodies[i]].x - x.now[bodies[i + 1]].x;
    const double distance = dp.norm();
    const Vec3 d = distance > kCoincident
                       ? Vec3(dp / distance)
                       : startDirection(x.start[bodies[i]].x - x.start[bodies[i + 1]].x);
    sum += distance;
    row.linear[i] += d.transpose();
    row.linear[i + 1] = -d.transpose();
  }
  row.c[0] = sum - length;
  if (rope) row.high = 0;  // pulls only
}

}  // namespace physics
