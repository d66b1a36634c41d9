// Loads of contacts that sweeps do not find, with the joints of their bodies.
#include <algorithm>
#include <cmath>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

// Of the lighter of two, with what joints hold to it, where the other is so much heavier that it
// takes many sweeps to find its load: each brings about what the lighter one weighs. 0: they are
// alike, or one hangs from what does not move and is not light.
double SmallSteps::Impl::lightMass(const Bodies& b, const KeptContact& c) const {
  const auto massOf = [&](BodyId i) {
    const int k = articulationOf[i];
    return k >= 0 ? articulatedMass[k] : b.mass[i];
  };
  if (!(b.inverse[c.a].m > 0 && b.inverse[c.b].m > 0)) return 0;
  const double a = massOf(c.a), other = massOf(c.b), light = std::min(a, other);
  const double heavy = std::max(a, other);
  return std::isfinite(heavy) && heavy > kMostCarried * light ? light : 0;
}

// Such a body carries much more than it weighs; what has no weight is hit, and lies on nothing.
bool SmallSteps::Impl::isOverloaded(const Model& w, const Batch& batch) const {
  const double g = gravityOf(w);
  if (!(g > 0)) return false;
  return std::any_of(batch.contacts.begin(), batch.contacts.end(), [&](int k) {
    const KeptContact& c = contacts[k];
    const double light = lightMass(w.bodies, c);
    if (!(light > 0) || !(c.step > 0)) return false;
    double sum = 0;
    for (int i = 0; i < c.count; ++i) sum += c.lambda[i];
    return sum > kMostCarried * light * g * c.step * c.step;
  });
}

// Before rows are prepared, and joints evaluated. Of one contact a sweep finds the load.
void SmallSteps::Impl::layAtOnce(Batch& batch) {
  const bool isOne = batch.contacts.size() == 1 && !batch.isMixed();
  batch.isAtOnce = batch.isAtOnce && !isOne && !batch.isSoft() && batch.softPairs.empty();
  if (!batch.isAtOnce) return;
  takeJoints(batch);
  newton.layOut(batch.blocks, batch.masses);
  batch.isAtOnce = newton.multiplications() <= kMostMultipliedAtOnce;
  if (!batch.isAtOnce) return;
  for (const int k : batch.contacts) contacts[k].held = {};
}

// Rows of joints in the units of the lanes.
void SmallSteps::Impl::takeJoints(Batch& batch) {
  sharedRows.clear();
  newton.joints.clear();
  batch.joints.addRows(sharedRows);
  const auto rootOf = [&](int slot) {
    Mat3 root = Mat3::Zero();
    for (int k = 0; k < 3; ++k) root.col(k) = rotationOf(batch.masses[slot], Vec3::Unit(k));
    return root;
  };
  for (const SharedRow& row : sharedRows) {
    const int a = row.bodies[0] == kWorldBody ? 0 : slotOf[row.bodies[0]];
    const int b = row.bodies[1] == kWorldBody ? 0 : slotOf[row.bodies[1]];
    ContactNewton::Joint& joint = newton.joints.emplace_back();
    joint.a = a, joint.b = b, joint.rows = row.rows, joint.alpha = row.alpha;
    joint.ofA << row.linear[0], row.angular[0] * rootOf(a);
    joint.ofB << row.linear[1], row.angular[1] * rootOf(b);
  }
}

// Bodies whose joints respond are where these have them, and respond to what they are given.
template <class F>
void SmallSteps::Impl::solveAtOnce(Batch& batch, F&& solve) {
  if (!batch.isAtOnce) return;
  takeJoints(batch);
  atOnceBefore.resize(batch.slots.size());
  const auto forEachResponder = [&](auto&& f) {
    for (std::size_t s = 1; s < batch.responders.size(); ++s) {
      if (batch.responders[s].articulation >= 0) f(static_cast<int>(s));
    }
  };
  forEachResponder([&](int slot) { atOnceBefore[slot] = lookAtResponse(batch, slot); });
  solve();
  forEachResponder([&](int slot) { respondTo(batch, slot, atOnceBefore[slot]); });
}

void SmallSteps::Impl::solvePositionsAtOnce(Batch& batch, PositionSweep which) {
  solveAtOnce(batch, [&] { newton.solvePositions(batch.blocks, batch.motions, which); });
}

void SmallSteps::Impl::solveVelocitiesAtOnce(Batch& batch) {
  solveAtOnce(batch, [&] { newton.solveVelocities(batch.blocks, batch.motions); });
}

}  // namespace physics
