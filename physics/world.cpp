// The step of "Displacement Based Dynamics", with the corrections listed in paper.md. Numbers in
// brackets are the paper's equations. A substep of the default method is small_steps/small_steps.h,
// Algorithm 1 of the paper stepping/substep.cpp.
#include "physics/world.h"

#include "physics/base/profile.h"
#include "physics/effects/local_substeps.h"
#include "physics/effects/skip_inactive.h"
#include "physics/effects/sleep.h"
#include "physics/model/factors.h"
#include "physics/stepping/not_finite.h"
#include "physics/stepping/substep.h"
#include "physics/world/impl.h"

namespace physics {
namespace {

void begin(WorldState& w, StepReport& report) {
  if (w.settings.contact) w.takeShapes();
  wakeCalled(w);
  for (const BodyId i : w.bodies.active) {
    w.last.pose[i] = w.bodies.pose[i];
    w.last.velocity[i] = w.bodies.velocity[i];
  }
  checkFinite(w, report);
  for (const auto& [body, velocity] : w.last.replaced) checkFinite(w, body, report);
  profileScope("arm");
  drive(w.arms, w.bodies, w.settings.dt, w.settings.accuracy);  // (149)-(154)
  profileScope("");
  takeFactors(w.kinds, w.bodies, w.time(), w.time() + w.settings.dt);
  keepStart(w);
}

void end(WorldState& w, StepReport& report) {
  if (report.notFinite) {
    restore(w);
  } else {
    profileScope("local_substeps");
    askForSubsteps(w);
    profileScope("sleep");
    fallAsleep(w, report);
    profileScope("");
  }
  for (const BodyId i : w.loaded) w.loads[i] = {};
  w.loaded.clear();
  w.last.replaced.clear();
  w.stepCount += report.notFinite ? 0 : 1;
}

void countLooks(const Collider::Counts& before, const Collider::Counts& after, StepReport& report) {
  report.work.broadPhase = after.broadPhaseCalls - before.broadPhaseCalls;
  report.work.narrowPhase = after.narrowPhaseCalls - before.narrowPhaseCalls;
}

// The default method.
void smallSteps(WorldState& w, StepReport& report) {
  w.small.step(
      w, [&w] { wakeCalled(w); }, report);
  nameHardest(w, report);
}

// The paper's methods and the rivals: all that is awake at once, or one group of islands after the
// other; anew where a group met what did not step with it.
void sweepSteps(WorldState& w, StepReport& report) {
  do {
    profileScope("local_substeps");
    takeGroups(w);
    profileScope("");
    if (w.local.groups.empty()) substeps(w, report);
    for (Group& group : w.local.groups) {
      enter(w, group);
      if (goesOn(w, report)) substeps(w, report);
      leave(w, group);
    }
    leaveGroups(w);
  } while (includeMet(w, report));
}

}  // namespace

StepReport World::step() {
  Impl& w = *impl_;
  const Collider::Counts before = w.collider.counts();
  StepReport report;
  begin(w, report);
  if (!report.notFinite)
    w.settings.takesSmallSteps() ? smallSteps(w, report) : sweepSteps(w, report);
  end(w, report);
  countLooks(before, w.collider.counts(), report);
  return report;
}

}  // namespace physics
