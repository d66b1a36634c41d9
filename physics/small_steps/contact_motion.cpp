// Bodies into the lanes that contacts work on, and back.
#include <algorithm>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

LaneBodies SmallSteps::Impl::lanesOf(Batch& batch) const {
  return {slotOf, batch.motions, batch.before, batch.masses, batch.inverses};
}

void SmallSteps::Impl::toLane(Batch& batch, int slot) {
  const Displacement& m = moved[batch.slots[slot]];
  lanesOf(batch).give(slot, m.u, m.theta);
}

void SmallSteps::Impl::fromLane(Batch& batch, int slot) {
  const BodyId i = batch.slots[slot];
  if (inertiaOf[i] == Inertia::kGiven) return;
  if (!batch.responders.empty() && batch.responders[slot].articulation >= 0) {
    return takeGiven(batch, slot);
  }
  const LaneBodies lanes = lanesOf(batch);
  if (!lanes.isChanged(slot)) return;
  const bool turns = inertiaOf[i] != Inertia::kNone;
  lanes.take(slot, moved[i].u, turns ? &moved[i].theta : nullptr);
}

// Of a body whose joints respond: what contacts gave it, as if it had none. They are to follow.
void SmallSteps::Impl::takeGiven(Batch& batch, int slot) {
  const BodyId i = batch.slots[slot];
  const Responder& from = batch.responders[slot];
  const JointResponse::Six given =
      articulations[from.articulation].response().takeGiven(from.place);
  moved[i].u += masses[i].inverse * given.head<3>();
  moved[i].theta += masses[i].inertia * torqueOf(batch.masses[slot], given.tail<3>());
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
  if (batch.responders.empty()) return;
  for (const int k : batch.articulations) articulations[k].response().forgetPulls();
}

}  // namespace physics
