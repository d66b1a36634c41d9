// Bodies into the lanes that contacts work on, and back.
#include <algorithm>
#include <cmath>

#include "physics/small_steps/small_steps_impl.h"

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

namespace {

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

}  // namespace

void SmallSteps::Impl::toLane(Batch& batch, int slot) {
  LaneMotion& lane = batch.motions[slot];
  const Displacement& m = moved[batch.slots[slot]];
  const Vec3 turn = turnOf(batch.masses[slot], m.theta);
  for (int k = 0; k < 3; ++k) {
    lane.u[k] = static_cast<float>(m.u[k]);
    lane.turn[k] = static_cast<float>(turn[k]);
  }
  std::copy(lane.u, lane.u + 3, batch.before[slot].u);
  std::copy(lane.turn, lane.turn + 3, batch.before[slot].turn);
}

// Only what the contacts changed since: what they leave alone stays as it was, to the last bit.
void SmallSteps::Impl::fromLane(Batch& batch, int slot) {
  const LaneMotion& lane = batch.motions[slot];
  LaneStart& before = batch.before[slot];
  const BodyId i = batch.slots[slot];
  if (inertiaOf[i] == Inertia::kGiven) return;
  const auto change = [](const float(&now)[3], float(&then)[3]) {
    Vec3 by;
    for (int k = 0; k < 3; ++k) {
      by[k] = double(now[k]) - then[k];
      then[k] = now[k];
    }
    return by;
  };
  moved[i].u += change(lane.u, before.u);
  if (inertiaOf[i] == Inertia::kNone) return;
  moved[i].theta += rotationOf(batch.masses[slot], change(lane.turn, before.turn));
}

void SmallSteps::Impl::toLanes(Model& w, Batch& batch) {
  w.workers.forEachChunk(static_cast<int>(batch.slots.size()), kLeastBodies, [&](int from, int to) {
    for (int s = std::max(from, 1); s < to; ++s) toLane(batch, s);
  });
}

void SmallSteps::Impl::fromLanes(Model& w, Batch& batch) {
  w.workers.forEachChunk(static_cast<int>(batch.slots.size()), kLeastBodies, [&](int from, int to) {
    for (int s = std::max(from, 1); s < to; ++s) fromLane(batch, s);
  });
}

// Rows are prepared once and hold for the substeps that follow, but where a body has turned so far
// that its arms and inertia are others.
bool SmallSteps::Impl::turnedFar(const Batch& batch) const {
  constexpr double kFar = 0.05;  // rad
  for (std::size_t s = 1; s < batch.motions.size(); ++s) {
    const auto& turn = batch.motions[s].dturn;
    const Vec3 theta = rotationOf(batch.masses[s], Vec3(turn[0], turn[1], turn[2]));
    if (theta.squaredNorm() > kFar * kFar) return true;
  }
  return false;
}

}  // namespace physics
