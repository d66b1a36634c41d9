// Islands whose joints a step's substeps could not close make it again, with twice as many.
#include <algorithm>
#include <iterator>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

// Before the first substep: what another attempt starts from.
void SmallSteps::Impl::keepStart(const Model& w, Batch& batch) {
  batch.kept.clear();
  if (batch.articulations.empty() && !stepsAccurately(w, batch)) return;
  for (const BodyId i : batch.bodies) {
    batch.kept.push_back({w.bodies.pose[i], w.bodies.velocity[i], meanSpins[i]});
  }
  for (const int d : batch.deformables) deformables[d].keep();
}

void SmallSteps::Impl::goBack(Bodies& b, const Batch& batch, std::size_t k) {
  const BodyId i = batch.bodies[k];
  b.pose[i] = batch.kept[k].pose;
  b.velocity[i] = batch.kept[k].velocity;
  meanSpins[i] = batch.kept[k].meanSpin;
}

bool SmallSteps::Impl::isOpened(const Batch& batch) const {
  return std::any_of(batch.articulations.begin(), batch.articulations.end(),
                     [&](int k) { return articulations[k].isOpened(); });
}

// Islands with joints that came apart, by their first bodies. What sweeps and ropes end with is
// where they start from: islands with those in them go on as they are.
bool SmallSteps::Impl::findOpened(const Batch& batch) {
  if (!isOpened(batch)) return false;
  const auto rootOf = [&](const auto& part) { return islands[part.bodies().front()]; };
  const bool mayHelp = 2 * batch.substeps <= kMostSubsteps;
  for (const BodyId i : batch.bodies) opened[islands[i]] = 0;
  for (const int k : batch.articulations) {
    if (articulations[k].isOpened() && mayHelp) opened[rootOf(articulations[k])] = 1;
  }
  for (const int k : batch.deformables) opened[rootOf(deformables[k])] = 0;
  bool any = false;
  for (const int k : batch.articulations) {
    const bool isAgain = opened[rootOf(articulations[k])] != 0;
    if (isAgain && articulations[k].isOpened()) finer[k] = 2 * batch.substeps;
    articulations[k].setOpened(isAgain);
    any = any || isAgain;
  }
  return any;
}

// Their bodies at the start of the step, and what holds them, in a batch of their own. Of what they
// carry nothing is taken over from this one.
void SmallSteps::Impl::moveTo(Model& w, Batch& batch, Batch& again) {
  const auto isOpened = [&](BodyId i) { return opened[islands[i]] != 0; };
  const auto isOf = [&](int k) {
    return isOpened(isMovable(w.bodies, contacts[k].a) ? contacts[k].a : contacts[k].b);
  };
  const auto isMoved = [&](int k) { return isOpened(articulations[k].bodies().front()); };
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
    const BodyId i = batch.bodies[k];
    if (!isOpened(i)) continue;
    again.bodies.push_back(i);
    goBack(w.bodies, batch, k);
    substeps[i] = again.substeps;
  }
  for (ContactBlock& block : batch.blocks) {
    for (int& k : block.contact) {
      if (k >= 0 && isOf(k)) k = -1;
    }
  }
  const auto move = [](std::vector<int>& from, std::vector<int>& to, auto&& is) {
    std::copy_if(from.begin(), from.end(), std::back_inserter(to), is);
    std::erase_if(from, is);
  };
  move(batch.contacts, again.contacts, isOf);
  move(batch.articulations, again.articulations, isMoved);
  std::erase_if(batch.bodies, isOpened);
}

// After the last substep.
void SmallSteps::Impl::makeAgain(Model& w, std::size_t index) {
  if (!findOpened(batches[index])) return;
  if (batchCount == batches.size()) batches.emplace_back();
  Batch &again = batches[batchCount++], &batch = batches[index];
  clear(again);
  again.substeps = 2 * batch.substeps;
  again.sweeps = batch.sweeps;
  again.touches = batch.touches;
  again.joined = batch.joined;
  again.isAgain = true;
  moveTo(w, batch, again);
}

// After a step that was made again the next one takes as many substeps, after any other it tries
// half of what the last one took.
void SmallSteps::Impl::askFiner(const Model& w, const Batch& batch) {
  for (const int k : batch.articulations) {
    if (!batch.isAgain) finer[k] /= 2;
    if (finer[k] <= w.settings.substeps.value_or(kLeastSolved)) finer[k] = 0;
    want(articulations[k].bodies().front(), finer[k], SubstepLaw::kOpened);
  }
}

}  // namespace physics
