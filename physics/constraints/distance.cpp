// Distance, (133)-(135).
#include "physics/constraints/distance.h"

#include "physics/constraints/between.h"

namespace physics {

void Distance::evaluate(const Configuration& x, Row<kBodies, kRows>& row) const {
  const Vec3 dp = between(x.now, bodies, anchors);
  const double distance = dp.norm();
  row.c[0] = distance - length;
  gradientAlong(distance > kCoincident ? Vec3(dp / distance) : Vec3::UnitY(), x.now, bodies,
                anchors, row);
  if (rope) row.high = 0;  // pulls only
}

}  // namespace physics
