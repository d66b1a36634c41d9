#include "physics/solver/lane_mass.h"

#include <cmath>

namespace physics {

// The root by Cholesky. A direction that nothing turns has a zero pivot, but for rounding.
LaneMass laneMassOf(const JointMass& mass) {
  constexpr double kRounding = 1e-13;
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
  return lane;
}

Vec3 rotationOf(const LaneMass& mass, const Vec3& turn) {
  const auto& r = mass.root;
  return {r[0] * turn.x(), r[1] * turn.x() + r[3] * turn.y(),
          r[2] * turn.x() + r[4] * turn.y() + r[5] * turn.z()};
}

Vec3 turnOf(const LaneMass& mass, const Vec3& theta) {
  const auto& r = mass.root;
  const double x = theta.x() / r[0], y = (theta.y() - r[1] * x) / r[3];
  return {x, y, (theta.z() - r[2] * x - r[4] * y) / r[5]};
}

Vec3 torqueOf(const LaneMass& mass, const Vec3& turn) {
  const auto& r = mass.root;
  const double z = turn.z() / r[5], y = (turn.y() - r[4] * z) / r[3];
  return {(turn.x() - r[1] * y - r[2] * z) / r[0], y, z};
}

}  // namespace physics
