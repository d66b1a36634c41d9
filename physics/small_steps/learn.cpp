// What contacts carry where nothing is known of it yet: the load that holds the bodies where they
// stand.
#include <algorithm>
#include <cmath>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// Loads find their way down a tower of n in some n^2 sweeps.
constexpr int kSweeps = 4096, kJointedSweeps = 32;

}  // namespace

// From rest, without moving: contacts do not give way, nor push. What is learnt of one island
// depends on no other.
void SmallSteps::Impl::learnLoads(Model& w) {
  fresh = false;
  const std::vector<Velocity> velocity = w.bodies.velocity;
  std::fill(w.bodies.velocity.begin(), w.bodies.velocity.end(), Velocity{});
  look(w);
  if (!contacts.empty()) {
    learning = true;
    for (const BodyId i : w.bodies.active) steps[i] = 1;
    divide(w);
    assign(w);
    for (std::size_t k = 0; k < batchCount; ++k) learnLoads(w, batches[k]);
    gatherSoft(w);
    for (Articulation& articulation : articulations) articulation.forget();
    learning = false;
  }
  w.bodies.velocity = velocity;
}

// By contact of the batch: its island's first body, its block, what that carried when it was last
// looked at, and its lane.
template <typename Visit>
void SmallSteps::Impl::forEachLane(const Model& w, Batch& batch, Visit&& visit) {
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) {
    ContactBlock& block = batch.blocks[k];
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      const KeptContact& c = contacts[block.contact[l]];
      visit(islands[isMovable(w.bodies, c.a) ? c.a : c.b], block, batch.told[k], l);
    }
  }
}

// After so many sweeps over contacts alone: no load of any island changes by more than numbers in
// single precision do where sweeps overshoot. Each island keeps what it carries once that is so.
bool SmallSteps::Impl::isBalanced(const Model& w, Batch& batch, int sweeps) {
  constexpr int kRound = 32;
  constexpr float kSettled = 1e-6f;  // of the largest load
  static_assert(kSweeps % kRound == 0);
  if (!learning || batch.isMixed() || sweeps % kRound != 0) return false;
  std::vector<float> changes(islands.size(), 0), largest(islands.size(), 0);
  forEachLane(w, batch, [&](BodyId root, const ContactBlock& block, ContactLoads& told, int l) {
    if (settled[root]) return;
    for (int k = 0; k < block.points; ++k) {
      const float load = block.point[k].lambda[l];
      changes[root] = std::max(changes[root], std::abs(load - told.point[k][l]));
      largest[root] = std::max(largest[root], load);
    }
    told.takeLane(block, l);
  });
  bool areAll = true;
  forEachLane(w, batch, [&](BodyId root, const ContactBlock&, const ContactLoads&, int) {
    if (changes[root] <= kSettled * largest[root]) settled[root] = 1;
    areAll = areAll && settled[root] != 0;
  });
  return areAll;
}

void SmallSteps::Impl::learnLoads(Model& w, Batch& batch) {
  const double h = w.settings.dt / batch.substeps;
  layOut(w, batch);
  batch.joints.take(articulations, batch.articulations);
  predict(w, batch, h, true);
  if (!batch.blocks.empty()) rows(w, batch, h);
  lookAgain(w, batch, h);
  batch.sweeps = batch.isMixed() ? kJointedSweeps : kSweeps;
  batch.told.assign(batch.blocks.size(), ContactLoads{});
  settled.assign(islands.size(), 0);
  solvePositions(w, batch, h);
  solveVelocities(w, batch, h);
  forEachLane(w, batch, [&](BodyId root, ContactBlock& block, const ContactLoads& told, int l) {
    if (settled[root]) told.giveLane(block, l);
  });
  batch.sweeps = 1;
  for (int i = 0; i < 2; ++i) takeOver(w, batch, h);  // as if it had been for two steps
  ask(w, batch, h);
  for (const int k : batch.contacts) {
    KeptContact& c = contacts[k];
    for (int p = 0; p < c.count; ++p) c.held[p] = c.lambda[p] / (h * h);
  }
}

}  // namespace physics
