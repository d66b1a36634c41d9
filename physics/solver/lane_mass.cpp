#include "physics/solver/lane_mass.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace physics {

// The root by Cholesky. A direction that nothing turns has a zero pivot, but for rounding.
LaneMass laneMassOf(const JointMass& mass) {
  constexpr double kRounding = 1e-13;  // 1e3 roundings of the trace
  const Mat3& m = mass.inertia;
  const double least = kRounding * m.trace();
  LaneMass lane;
  lane.inverse = static_cast<float>(mass.inverse);
  double l00 = LaneMass::kUnturned, l10 = 0, l20 = 0;
  if (m(0, 0) > least) {
    l00 = std::sqrt(m(0, 0));
    l10 = m(1, 0) / l00;
    l20 = m(2, 0) / l00;
  }
  double l11 = LaneMass::kUnturned, l21 = 0;
  const double second = m(1, 1) - l10 * l10;
  if (second > least) {
    l11 = std::sqrt(second);
    l21 = (m(2, 1) - l20 * l10) / l11;
  }
  const double third = m(2, 2) - l20 * l20 - l21 * l21;
  const double l22 = third > least ? std::sqrt(third) : LaneMass::kUnturned;
  const double entries[6] = {l00, l10, l20, l11, l21, l22};
  for (int k = 0; k < 6; ++k) lane.root[k] = static_cast<float>(entries[k]);
  for (const int k : {0, 3, 5}) {  // that of a body too heavy for single precision is no zero
    lane.root[k] = std::max(lane.root[k], std::numeric_limits<float>::min());
  }
  return lane;
}

LaneInverse inverseOf(const LaneMass& mass) {
  const auto& r = mass.root;
  const double i00 = 1.0 / r[0], i11 = 1.0 / r[3], i22 = 1.0 / r[5], i10 = -r[1] * i00 * i11;
  return {{i00, i10, -(r[2] * i00 + r[4] * i10) * i22, i11, -r[4] * i11 * i22, i22}};
}

Vec3 torqueOf(const LaneMass& mass, const Vec3& turn) {
  const auto& r = mass.root;
  const double z = turn.z() / r[5], y = (turn.y() - r[4] * z) / r[3];
  return {(turn.x() - r[1] * y - r[2] * z) / r[0], y, z};
}

}  // namespace physics
