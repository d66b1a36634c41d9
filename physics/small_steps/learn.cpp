// What contacts carry where nothing is known of it yet: the load that holds the bodies where they
// stand.
#include <algorithm>
#include <cmath>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// Where friction is among what holds bodies, sweeps find the loads; down a tower of n in some n^2.
constexpr int kSweeps = 4096, kJointedSweeps = 32;
// Solves for all normal loads at once. The first finds which points press, and gives way by a
// millionth of what bodies resist: the loads of a tower of n are off by 0.4 n^2 of that, 0.4 % for
// 100, and it sways by 25 mm after ten seconds. Those that follow go on from there, to 6e-8: 0.1
// mm.
constexpr int kSolves = 3;
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
    rounds.assign(islands.size(), {});
    for (const BodyId i : w.bodies.active) {
      const BodyId root = islands[i];
      if (i != root && joined[root] == Joined::kNot) rounds[root].isAlone = true;
    }
    assign(w);
    for (std::size_t k = 0; k < batchCount; ++k) learnLoads(w, batches[k]);
    gatherSoft(w);
    for (Articulation& articulation : articulations) articulation.forget();
    batches.clear();  // one to a tower
    batchCount = 0;
    rounds = {};
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
  for (const BodyId i : batch.bodies) {
    rounds[i].most = rounds[i].largest = 0;
    load[i] = carried[i] = 0;
  }
  forEachLane(w, batch, [&](BodyId root, const ContactBlock& block, LoadRound& round, int l) {
    IslandRound& of = rounds[root];
    if (of.isSettled) return;
    for (int k = 0; k < block.points; ++k) {
      const float last = round.change.point[k][l], now = block.point[k].lambda[l];
      const float change = now - round.told.point[k][l];
      of.most = std::max(of.most, std::abs(change));
      of.largest = std::max(of.largest, now);
      load[root] += double(last) * last;
      carried[root] += double(last) * change;
      round.change.point[k][l] = change;
    }
    round.told.takeLane(block, l);
  });
  bool areAll = true;
  for (const BodyId i : batch.bodies) {
    IslandRound& of = rounds[i];
    if (islands[i] == i && of.most <= kSettled * of.largest) of.isSettled = true;
    areAll = areAll && rounds[islands[i]].isSettled;
  }
  if (!areAll && sweeps / kRound % kRounds == 0) goAhead(w, batch);
  return areAll;
}

// What sweeps have yet to bring shrinks from round to round, in the end all of it by the same r: it
// is r / (1 - r) of the last change (Aitken). Of each island by its own; sweeps put right the rest.
void SmallSteps::Impl::goAhead(const Model& w, Batch& batch) {
  for (const BodyId i : batch.bodies) {
    const double r =
        islands[i] == i && load[i] > 0 && !rounds[i].isSettled ? carried[i] / load[i] : 0;
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
    contactKernels().give(&more, 1, batch.motions.data());
  }
}

// Of an island by itself, what holds it without friction; sweeps go on from there.
void SmallSteps::Impl::learnNormalLoads(Batch& batch) {
  if (batch.isMixed() || batch.blocks.empty()) return;
  if (!rounds[islands[batch.bodies.front()]].isAlone) return;
  ContactNewton all;
  all.layOut(batch.blocks, batch.masses);
  for (int k = 0; k < kSolves && all.fill() <= kMostFill; ++k) {
    all.solveVelocities(batch.blocks, batch.motions, k == 0 ? ContactNewton::kMostSteps : 1);
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
  solvePositions(w, batch, h);
  learnNormalLoads(batch);
  solveVelocities(w, batch, h);
  forEachLane(w, batch, [&](BodyId root, ContactBlock& block, const LoadRound& round, int l) {
    if (rounds[root].isSettled) round.told.giveLane(block, l);
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
