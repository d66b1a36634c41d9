// Restitution: what the contacts of a batch give back of the speed that they took.
#include <algorithm>

#include "physics/base/profile.h"
#include "physics/motion/restitution.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {

// At the start of a substep, with the velocities that nothing has stopped yet: gaps and approach.
void SmallSteps::Impl::noteApproach(Model& w, Batch& batch, double h) {
  batch.impacts.pairs.clear();
  if (!(w.bodies.mostRestitution > 0) || batch.contacts.empty()) return;
  w.velocityBefore = w.bodies.velocity;
  for (const int k : batch.contacts) {
    ContactPair& pair = batch.impacts.pairs.emplace_back(pairOf(contacts[k], h));
    measureStart(pair, w.bodies);
  }
  forEachLane(batch, [&](const ContactBlock& block, int lane, int place) {
    ContactPair& pair = batch.impacts.pairs[place];
    for (int k = 0; k < pair.count; ++k) {
      // What was stopped before it touched has yet to hit.
      pair.points[k].loaded =
          block.point[k].lambda[lane] > 0 && !(pair.points[k].gapAtStart > kClose);
    }
  });
}

void SmallSteps::Impl::bounce(Model& w, Batch& batch, double h) {
  if (batch.impacts.pairs.empty()) return;
  profileScope("restitution");
  Bodies& b = w.bodies;
  forEachLane(batch, [&](const ContactBlock& block, int lane, int place) {
    ContactPair& pair = batch.impacts.pairs[place];
    double sum = 0;
    for (int k = 0; k < pair.count; ++k) sum += block.point[k].lambda[lane];
    Vec3 friction = Vec3::Zero();
    for (const auto& t : block.tangent) {
      friction += double(t.lambda[lane]) * Vec3(t.d[0][lane], t.d[1][lane], t.d[2][lane]);
    }
    for (int k = 0; k < pair.count; ++k) {
      pair.points[k].normalTotal = block.point[k].lambda[lane];
      pair.points[k].frictionTotal.setZero();
      if (sum > 0) pair.points[k].frictionTotal = pair.points[k].normalTotal / sum * friction;
    }
  });
  const int slots = static_cast<int>(batch.slots.size());
  for (int s = 1; s < slots; ++s) tellBody(batch, s);
  for (const BodyId i : batch.bodies) b.inverse[i].inertia = masses[i].inertia;
  std::vector<Vec3> before(slots);
  for (int s = 1; s < slots; ++s) before[s] = b.pose[batch.slots[s]].x;
  restitute(batch.impacts, b, w.flight(h));
  passOn(w, batch, h);
  for (int s = 1; s < slots; ++s) {  // what was flown after the hit
    const Vec3 flown = b.pose[batch.slots[s]].x - before[s];
    for (int k = 0; k < 3; ++k) batch.motions[s].du[k] += static_cast<float>(flown[k]);
  }
  profileScope("");
}

// What a limb alone was given back is for all that joints hold to it: until the next substep it
// would be energy that nothing gave.
void SmallSteps::Impl::passOn(Model& w, Batch& batch, double h) {
  Bodies& b = w.bodies;
  const auto forEachJointed = [&](auto&& f) {
    for (const int k : batch.articulations) {
      for (const BodyId i : articulations[k].bodies()) {
        if (b.motion[i] == Motion::kDynamic) f(i, moved[i], b.velocity[i]);
      }
    }
  };
  bool some = false;
  forEachJointed([&](BodyId i, Displacement& m, const Velocity& v) {
    const double rate = 1 / length[i];
    some = some || v.v != rate * m.u || v.w != rate * m.theta;
    m = {h * v.v, h * v.w};
  });
  if (!some) return;
  batch.joints.solveVelocities({w.kinds, b.pose, b.start, h, masses, moved});
  forEachJointed([&](BodyId, const Displacement& m, Velocity& v) { v = {m.u / h, m.theta / h}; });
}

}  // namespace physics
