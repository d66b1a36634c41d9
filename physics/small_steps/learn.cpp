// What contacts carry where nothing is known of it yet: the load that holds the bodies where they
// stand.
#include <algorithm>

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

// After so many sweeps over contacts alone: all others change nothing, to the last bit, as they go
// round in a circle of which they make whole turns.
bool SmallSteps::Impl::isBalanced(Batch& batch, int sweeps) {
  constexpr int kRound = 32;
  static_assert(kSweeps % kRound == 0);
  if (!learning || batch.isMixed() || sweeps % kRound != 0) return false;
  bool isSame = balanced.size() == batch.motions.size() && sweeps > kRound;
  batch.told.resize(batch.blocks.size());
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) {
    const ContactLoads loads = loadsOf(batch.blocks[k]);
    isSame = isSame && loads == batch.told[k];
    batch.told[k] = loads;
  }
  for (std::size_t s = 0; isSame && s < balanced.size(); ++s) {
    isSame = std::equal(balanced[s].u, balanced[s].u + 3, batch.motions[s].u) &&
             std::equal(balanced[s].turn, balanced[s].turn + 3, batch.motions[s].turn);
  }
  balanced = batch.motions;
  return isSame;
}

void SmallSteps::Impl::learnLoads(Model& w, Batch& batch) {
  const double h = w.settings.dt / batch.substeps;
  layOut(w, batch);
  batch.joints.take(articulations, batch.articulations);
  predict(w, batch, h, true);
  if (!batch.blocks.empty()) rows(w, batch, h);
  lookAgain(w, batch, h);
  batch.sweeps = batch.isMixed() ? kJointedSweeps : kSweeps;
  solvePositions(w, batch, h);
  solveVelocities(w, batch, h);
  batch.sweeps = 1;
  for (int i = 0; i < 2; ++i) takeOver(w, batch, h);  // as if it had been for two steps
  ask(w, batch, h);
  for (const int k : batch.contacts) {
    KeptContact& c = contacts[k];
    for (int p = 0; p < c.count; ++p) c.held[p] = c.lambda[p] / (h * h);
  }
}

}  // namespace physics
