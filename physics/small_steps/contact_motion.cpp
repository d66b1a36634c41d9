// Bodies into the lanes that contacts work on, and back.
#include <algorithm>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

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
  if (!batch.responders.empty() && batch.responders[slot].articulation >= 0) {
    return takeGiven(batch, slot);
  }
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

// Of a body whose joints respond: what contacts gave it, as if it had none. They are to follow.
void SmallSteps::Impl::takeGiven(Batch& batch, int slot) {
  const BodyId i = batch.slots[slot];
  float(&given)[6] = batch.responders[slot].given;
  const Vec3 turn(given[3], given[4], given[5]);
  moved[i].u += masses[i].inverse * Vec3(given[0], given[1], given[2]);
  moved[i].theta += masses[i].inertia * torqueOf(batch.masses[slot], turn);
  std::fill(std::begin(given), std::end(given), 0.f);
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

}  // namespace physics
