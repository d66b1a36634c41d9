// A substep (Algorithm 1): predict, find contacts, prepare, iterate, apply, finish.
#include "physics/stepping/substep.h"

#include "physics/base/profile.h"
#include "physics/effects/choose_scheme.h"
#include "physics/effects/skip_inactive.h"
#include "physics/model/factors.h"
#include "physics/motion/restitution.h"
#include "physics/motion/second_order.h"
#include "physics/rivals/rival.h"
#include "physics/stepping/not_finite.h"
#include "physics/sweep/direct.h"
#include "physics/sweep/nonlinear_gauss_seidel.h"
#include "physics/sweep/project.h"

namespace physics {
namespace {

bool contactsOutdated(const WorldState& w) {
  return w.touches && w.collider.outdated(poseAtStart(w), w.bodies.pose, w.bodies.active);
}

// Where the bodies would be at the end of the whole step, so that one look serves all its substeps.
bool findContactsAhead(WorldState& w, double remaining) {
  for (const BodyId i : w.bodies.active) {
    w.ahead[i] = w.bodies.pose[i];
    displace(w.ahead[i], remaining * w.bodies.velocity[i].v, remaining * w.bodies.velocity[i].w);
  }
  return findContacts(w, w.ahead);
}

// At the start of a substep, whose number is k. Local substeps have looked for the whole step.
bool lookForContacts(WorldState& w, int k, double h) {
  const bool isNew = k == 0 && w.local.groups.empty();
  if (w.touches && (isNew || contactsOutdated(w))) {
    if (!findContactsAhead(w, w.settings.dt - (k + 1) * h)) return false;
  }
  return findSoftContacts(w);
}

void solveConstraints(WorldState& w, double h, StepReport& report) {
  switch (w.settings.method) {
    case Method::kNonlinearGaussSeidel:
    case Method::kSmallSteps:  // where it does not take what the world has
      return nonlinearGaussSeidel(w, h, report);
    case Method::kDirect:
      return direct(w, h, report);
    case Method::kLinearGaussSeidel:
      return linearGaussSeidel(w, h, report);
    default:
      return;  // a rival has a substep of its own
  }
}

void takeFactors(WorldState& w, int k, double h) {
  takeFactors(w.kinds, w.bodies, w.time() + k * h, w.time() + (k + 1) * h);
}

// From X^t, v^t to the displaced poses, by the schemes as they stand.
void displaceAll(WorldState& w, int k, double h, StepReport& report) {
  takeFactors(w, k, h);
  profileScope("motion");
  if (isSecondOrder(w.settings)) {
    moveFreelySecondOrder(w.bodies, w.loads, w.settings.gravity, h);
  } else {
    moveFreely(w.bodies, w.loads, w.settings.gravity, h);  // X^{t+1} (28)-(31)
  }
  profileScope("inertia");
  refreshInverseMasses(w, h);
  profileScope("");
  checkFinite(w, report);
  if (report.notFinite || !lookForContacts(w, k, h)) return;
  if (w.settings.method == Method::kDirect) {
    profileScope("direct");
    prepareDirect(w);
  }
  prepareConstraints(w, h);        // multipliers of the last substep, gaps and anchors at X^t
  solveConstraints(w, h, report);  // Delta X (52),(53)
}

bool lowersSchemes(WorldState& w, double h) {
  profileScope("schemes");
  return lowerSchemes(w, h);
}

// A scheme that the solve does not bear out is lowered and the substep made anew; the third time
// everything steps by the paper's.
void displaceBySchemes(WorldState& w, int k, double h, StepReport& report) {
  profileScope("schemes");
  w.contactsBefore = w.contacts.pairs;
  chooseSchemes(w);
  displaceAll(w, k, h, report);
  for (int again = 0; again < 3 && goesOn(w, report) && lowersSchemes(w, h); ++again) {
    profileScope("schemes");
    if (again == 2) stepByPaper(w);
    rewind(w.bodies);
    w.contacts.pairs = w.contactsBefore;
    displaceAll(w, k, h, report);
  }
}

void finish(WorldState& w, double h, StepReport& report) {
  profileScope("");
  const bool bounces = w.touches && w.bodies.mostRestitution > 0;
  if (bounces) w.velocityBefore = w.bodies.velocity;
  if (isSecondOrder(w.settings)) {
    profileScope("schemes");
    finishSecondOrder(w.bodies, w.loads, w.settings.gravity);
    projectVelocities(w);
  } else {
    finishVelocities(w.bodies, h);  // (43)-(46)
  }
  std::vector<bool> jumped;
  if (bounces) {
    profileScope("restitution");
    jumped = restitute(w.contacts, w.bodies, w.flight(h));
  }
  if (isSecondOrder(w.settings)) {
    profileScope("schemes");
    recordSchemes(w, jumped, report);
  }
  profileScope("");
}

void countSubstep(const WorldState& w, StepReport& report) {
  ++report.substeps;
  report.work.moves += static_cast<std::int64_t>(w.bodies.active.size());
  report.work.turns += w.turning;
  report.work.gyroscopic += static_cast<std::int64_t>(
      w.settings.leavesOut ? w.bodies.anisotropic.size() : static_cast<std::size_t>(w.turning));
}

// A whole substep of a rival, from contacts found as for the other methods.
void substepOfRival(WorldState& w, int k, double h, StepReport& report) {
  takeFactors(w, k, h);
  profileScope("motion");
  coast(w, h);
  checkFinite(w, report);
  if (report.notFinite) return;
  lookForContacts(w, k, h);
  profileScope("rival");
  rivalSubstep(w, h, report);
  profileScope("");
  checkSolved(w, report);
  countSubstep(w, report);
}

void substep(WorldState& w, int k, double h, StepReport& report) {
  w.substep = k;
  const bool isStatic = w.settings.stepping == Stepping::kStatic;
  if (isStatic) bringToRest(w.bodies);
  if (isRival(w.settings.method)) return substepOfRival(w, k, h, report);
  isSecondOrder(w.settings) ? displaceBySchemes(w, k, h, report) : displaceAll(w, k, h, report);
  if (!goesOn(w, report)) return;
  finish(w, h, report);
  checkSolved(w, report);
  if (isStatic) bringToRest(w.bodies);
  countSubstep(w, report);
}

}  // namespace

bool goesOn(const WorldState& w, const StepReport& report) {
  return !report.notFinite && w.met.empty();
}

void substeps(WorldState& w, StepReport& report) {
  report.substeps = 0;
  const double h = w.substepLength();
  for (int k = 0; k < w.substeps && goesOn(w, report); ++k) substep(w, k, h, report);
}

}  // namespace physics
