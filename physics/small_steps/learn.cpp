// What contacts carry where nothing is known of it yet: the load that holds the bodies where they
// stand.
#include <algorithm>
#include <cmath>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// Loads find their way down a tower of n in some n^2 sweeps.
constexpr int kSweeps = 4096, kJointedSweeps = 32;
// Rounds of sweeps from one look ahead to the next: what it stirred up has to settle.
constexpr int kRounds = 4;

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
      visit(rootOf(w, c), block, learnt[k], l);
    }
  }
}

// After so many sweeps over contacts alone: no load of any island changes by more than numbers in
// single precision do where sweeps overshoot. Each island keeps what it carries once that is so.
bool SmallSteps::Impl::isBalanced(const Model& w, Batch& batch, int sweeps) {
  constexpr int kRound = 16;         // a look visits all loads, as a sweep does: one in so many
  constexpr float kSettled = 1e-6f;  // of the largest load
  static_assert(kSweeps % kRound == 0);
  if (!learning || batch.isMixed() || sweeps % kRound != 0) return false;
  std::vector<float> most(islands.size(), 0), largest(islands.size(), 0);
  for (const BodyId i : batch.bodies) load[i] = carried[i] = 0;
  forEachLane(w, batch, [&](BodyId root, const ContactBlock& block, LoadRound& round, int l) {
    if (settled[root]) return;
    for (int k = 0; k < block.points; ++k) {
      const float last = round.change.point[k][l], now = block.point[k].lambda[l];
      const float change = now - round.told.point[k][l];
      most[root] = std::max(most[root], std::abs(change));
      largest[root] = std::max(largest[root], now);
      load[root] += double(last) * last;
      carried[root] += double(last) * change;
      round.change.point[k][l] = change;
    }
    round.told.takeLane(block, l);
  });
  bool areAll = true;
  for (const BodyId i : batch.bodies) {
    if (islands[i] == i && most[i] <= kSettled * largest[i]) settled[i] = 1;
    areAll = areAll && settled[islands[i]] != 0;
  }
  if (!areAll && sweeps / kRound % kRounds == 0) goAhead(w, batch);
  return areAll;
}

// What sweeps have yet to bring shrinks from round to round, in the end all of it by the same r: it
// is r / (1 - r) of the last change (Aitken). Of each island by its own; sweeps put right the rest.
void SmallSteps::Impl::goAhead(const Model& w, Batch& batch) {
  for (const BodyId i : batch.bodies) {
    const double r = islands[i] == i && load[i] > 0 && !settled[i] ? carried[i] / load[i] : 0;
    change[i] = r > 0 && r < 1 ? r / (1 - r) : 0;
  }
  for (std::size_t k = 0; k < batch.blocks.size(); ++k) {
    ContactBlock& block = batch.blocks[k];
    LoadRound& round = learnt[k];
    ContactBlock more = block;
    for (auto& t : more.tangent) std::fill(std::begin(t.lambda), std::end(t.lambda), 0.f);
    std::fill(std::begin(more.twist), std::end(more.twist), 0.f);
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      const double ahead = block.contact[l] < 0 ? 0 : change[rootOf(w, contacts[block.contact[l]])];
      for (int p = 0; p < block.points; ++p) {
        float& lambda = block.point[p].lambda[l];
        const float then =
            std::max(0.f, lambda + static_cast<float>(ahead) * round.change.point[p][l]);
        more.point[p].lambda[l] = then - lambda;
        lambda = round.told.point[p][l] = then;
      }
    }
    contactKernels().warmStart(&more, 1, batch.motions.data());
  }
}

void SmallSteps::Impl::learnLoads(Model& w, Batch& batch) {
  const double h = w.settings.dt / batch.substeps;
  layOut(w, batch);
  batch.joints.take(articulations, batch.articulations);
  for (const BodyId i : batch.bodies) length[i] = h;
  predict(w, batch, true);
  if (!batch.blocks.empty()) rows(w, batch);
  lookAgain(w, batch, h);
  batch.sweeps = batch.isMixed() ? kJointedSweeps : kSweeps;
  learnt.assign(batch.blocks.size(), LoadRound{});
  settled.assign(islands.size(), 0);
  solvePositions(w, batch, h);
  solveVelocities(w, batch, h);
  forEachLane(w, batch, [&](BodyId root, ContactBlock& block, const LoadRound& round, int l) {
    if (settled[root]) round.told.giveLane(block, l);
  });
  learnt = {};
  batch.sweeps = 1;
  for (int i = 0; i < 2; ++i) takeOver(w, batch);  // as if it had been for two steps
  ask(w, batch);
  for (const int k : batch.contacts) {
    KeptContact& c = contacts[k];
    for (int p = 0; p < c.count; ++p) c.held[p] = c.lambda[p] / (h * h);
  }
}

}  // namespace physics
