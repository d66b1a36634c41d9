// The default method: the step of its islands.
#include "physics/small_steps/small_steps.h"

#include <algorithm>
#include <limits>

#include "physics/model/factors.h"
#include "physics/model/finite.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {

SmallSteps::SmallSteps() : impl_(std::make_unique<Impl>()) {}
SmallSteps::~SmallSteps() = default;
SmallSteps::SmallSteps(SmallSteps&&) noexcept = default;
SmallSteps& SmallSteps::operator=(SmallSteps&&) noexcept = default;

std::vector<KeptContact>& SmallSteps::contacts() { return impl_->contacts; }
const std::vector<KeptContact>& SmallSteps::contacts() const { return impl_->contacts; }
void SmallSteps::topologyChanged() { impl_->known = false; }
int SmallSteps::substepsOf(BodyId body) const {
  return body < static_cast<BodyId>(impl_->substeps.size()) ? impl_->substeps[body] : 1;
}
void SmallSteps::forget() {
  impl_->contacts.clear();
  sleeping.clear();
  impl_->known = false;
  impl_->fresh = true;
  std::fill(impl_->asked.begin(), impl_->asked.end(), 0);
  std::fill(impl_->meanSpins.begin(), impl_->meanSpins.end(), Vec3::Zero());
  std::fill(impl_->askedSweeps.begin(), impl_->askedSweeps.end(), 1);
  std::fill(impl_->askedAtOnce.begin(), impl_->askedAtOnce.end(), 0);
  std::fill(impl_->finer.begin(), impl_->finer.end(), 0);
  std::fill(impl_->law.begin(), impl_->law.end(), SubstepLaw{});
  // Of what steps by an accuracy.
  impl_->choices.clear();
  impl_->oneRowErrs.clear();
  impl_->missed.clear();
  impl_->accelerated.clear();
  impl_->makeRoom(impl_->asked.size());
}

std::size_t SmallSteps::bytes() const {
  std::size_t sum = (impl_->contacts.capacity() + impl_->before.capacity()) * sizeof(KeptContact);
  for (const Batch& batch : impl_->batches) {
    sum += batch.blocks.capacity() * sizeof(ContactBlock) +
           batch.motions.capacity() * sizeof(LaneMotion) +
           batch.lanes.capacity() * sizeof(BodyBlock);
  }
  return sum;
}

void SmallSteps::Impl::makeRoom(std::size_t bodies) {
  substeps.resize(bodies, 1);
  sweeps.resize(bodies, 1);
  asked.resize(bodies, 0);
  askedSweeps.resize(bodies, 1);
  askedAtOnce.resize(bodies, 0);
  atOnce.resize(bodies);
  uneven.resize(bodies);
  hangs.resize(bodies);
  law.resize(bodies);
  batchOf.resize(bodies);
  slotOf.resize(bodies);
  inertiaOf.resize(bodies);
  length.resize(bodies);
  masses.resize(bodies);
  moved.resize(bodies);
  stiffness.resize(bodies, Mat3::Zero());
  radius.resize(bodies);
  thickness.resize(bodies);
  pushed.resize(bodies, Vec3::Zero());
  push.resize(bodies);
  inertias.resize(bodies);
  spins.resize(bodies);
  meanSpins.resize(bodies, Vec3::Zero());
  choices.resize(bodies, StepChoice(1, 2, kMostTouchingColumns, StepChoice::Rows::kInTurn));
  oneRowErrs.resize(bodies, std::numeric_limits<double>::infinity());
  missed.resize(bodies);
  accelerated.resize(bodies);
  load.resize(bodies);
  sag.resize(bodies);
  drawn.resize(bodies);
  carried.resize(bodies);
  weight.resize(bodies);
  energy.resize(bodies);
  whole.resize(bodies);
  held.resize(bodies);
  joined.resize(bodies);
  deforms.resize(bodies);
  predicted.resize(bodies);
  opened.resize(bodies);
  change.resize(bodies);
  turns.resize(bodies);
  changeBefore.resize(bodies);
}

// Substeps of h from where the bodies are, and from `now` on. What contacts and joints carried
// before is as it was.
void SmallSteps::Impl::run(Model& w, Batch& batch, double h, int count, StepReport& report) {
  for (const BodyId i : batch.bodies) length[i] = h;
  runSubsteps(w, batch, h, count, report);
}

// The same, of islands without constraints each in its own length.
void SmallSteps::Impl::runSubsteps(Model& w, Batch& batch, double h, int count,
                                   StepReport& report) {
  batch.joints.take(articulations, batch.articulations);
  batch.joints.seeStart({w.kinds, w.bodies.pose, w.bodies.pose, h, masses, moved});
  for (int i = 0; i < count; ++i) {
    takeFactors(w.kinds, w.bodies, now + i * h, now + (i + 1) * h);
    predict(w, batch, i == 0);
    if (i == 0 && !batch.blocks.empty()) rows(w, batch);
    if (i > 0 || batch.isAgain) lookAtSliding(w, batch);
    lookAgain(w, batch, h);
    noteApproach(w, batch, h);
    substep(w, batch, h, report);
  }
  report.work.moves += static_cast<std::int64_t>(batch.bodies.size()) * count;
}

// What it leaves to the next step.
void SmallSteps::Impl::finish(Model& w, Batch& batch, double h) {
  takeOver(w, batch);
  holdCarried(w, batch, h);
  ask(w, batch);
  batch.joints.finish(w.kinds, h);
  for (const int d : batch.deformables) deformables[d].finish(w.kinds, h);
}

// Islands, and batches, to which others are added while they step.
void SmallSteps::Impl::advance(Model& w, StepReport& report) {
  const double dt = w.settings.dt;
  look(w);
  now = w.time();
  divide(w);
  advanceAccurately(w, report.accuracy);
  assign(w);
  tell(w);
  fly(w);
  report.work.moves += static_cast<std::int64_t>(free.size());
  for (std::size_t k = 0; k < batchCount; ++k) {
    const int count = batches[k].substeps;
    const double h = dt / count;
    report.substeps = std::max(report.substeps, count);
    if (stepsAccurately(w, batches[k])) continue;
    layOut(w, batches[k]);
    keepStart(w, batches[k]);
    run(w, batches[k], h, count, report);
    makeAgain(w, k);
    finish(w, batches[k], h);
  }
  advanceTouching(w, report);
  gatherSoft(w);
  checkFinite(w, report);
}

void SmallSteps::step(Model& w, const std::function<void()>& wake, StepReport& report) {
  impl_->wake = &wake;
  impl_->learn(w);
  Impl::takeForces(w);
  if (impl_->fresh && w.touches) impl_->learnLoads(w);
  impl_->advance(w, report);
}

}  // namespace physics
