// The step: Algorithm 1 of "Displacement Based Dynamics", with the corrections listed in paper.md.
// Numbers in brackets are the paper's equations.
#include "physics/world.h"

#include <cmath>

#include "physics/choose_scheme.h"
#include "physics/effects/restitution.h"
#include "physics/effects/second_order.h"
#include "physics/methods/direct.h"
#include "physics/methods/nonlinear_gauss_seidel.h"
#include "physics/methods/rival.h"
#include "physics/world_impl.h"

namespace physics {
namespace {

constexpr int kMostLooks = 4;  // how often contacts are looked for anew within one substep

// X^t; Bodies::start is where backward Euler would have started.
std::span<const Pose> poseAtStart(const World::Impl& w) {
  return w.bodies.second.empty() ? w.bodies.start : w.bodies.second.origin;
}

// Manifolds for the motion from the start of the substep to `target`.
void findContacts(World::Impl& w, std::span<const Pose> target) {
  update(w.contacts, w.collider.find(poseAtStart(w), target, w.settings.contact->margin), w.bodies);
}

bool contactsOutdated(const World::Impl& w) {
  return w.settings.contact && w.collider.outdated(poseAtStart(w), w.bodies.pose);
}

// Points and links are looked at anew in every substep: their planes turn quickly.
void findSoftContacts(World::Impl& w) {
  if (!w.settings.contact || w.softCollider.empty()) return;
  const auto touches =
      w.softCollider.find(poseAtStart(w), w.bodies.pose, w.settings.contact->margin);
  startSoftContacts(touches, w.softCollider, w.bodies, w.softContacts);
}

// Where the bodies would be at the end of the whole step, so that one look serves all its substeps.
void findContactsAhead(World::Impl& w, double remaining) {
  w.ahead.resize(w.bodies.pose.size());
  for (int i = 0; i < w.bodies.size(); ++i) {
    w.ahead[i] = w.bodies.pose[i];
    displace(w.ahead[i], remaining * w.bodies.velocity[i].v, remaining * w.bodies.velocity[i].w);
  }
  findContacts(w, w.ahead);
}

void solveOnce(World::Impl& w, double h, StepReport& report) {
  switch (w.settings.method) {
    case Method::kNonlinearGaussSeidel:
      return nonlinearGaussSeidel(w, h, report);
    case Method::kDirect:
      return direct(w, h, report);
    case Method::kLinearGaussSeidel:
      return linearGaussSeidel(w, h, report);
    default:
      return;  // a rival has a substep of its own
  }
}

// Contacts that moved something and may not be found again.
void keepLost(World::Impl& w) {
  if (!isSecondOrder(w.settings)) return;
  for (const ContactPair& pair : w.contacts.pairs) {
    if (!pair.given.isZero(0)) w.stepper.lost.push_back(meetingOf(w, pair));
  }
}

void solveConstraints(World::Impl& w, double h, StepReport& report) {
  solveOnce(w, h, report);
  // A body that was hit may have left the bounds in which contacts were looked for: look where it
  // went.
  for (int look = 1; look < kMostLooks && !report.notFinite && contactsOutdated(w); ++look) {
    keepLost(w);
    findContacts(w, w.bodies.pose);
    for (ContactPair& pair : w.contacts.pairs) measureStart(pair, w.bodies);
    solveOnce(w, h, report);
  }
}

void checkFinite(const World::Impl& w, StepReport& report) {
  for (int i = 0; i < w.bodies.size() && !report.notFinite; ++i) {
    const Pose& pose = w.bodies.pose[i];
    const Velocity& velocity = w.bodies.velocity[i];
    if (!std::isfinite(pose.x.sum() + pose.q.coeffs().sum() + velocity.v.sum() +
                       velocity.w.sum())) {
      report.notFinite = {report.substeps, i, ""};
    }
  }
}

// From X^t, v^t to the displaced poses, by the schemes as they stand.
void displaceAll(World::Impl& w, int k, double h, StepReport& report) {
  if (isSecondOrder(w.settings)) {
    w.stepper.lost.clear();
    moveFreelySecondOrder(w.bodies, w.loads, w.settings.gravity, h);
  } else {
    moveFreely(w.bodies, w.loads, w.settings.gravity, h);  // X^{t+1} (28)-(31)
  }
  refreshInverseMasses(w, h);
  checkFinite(w, report);
  if (report.notFinite) return;
  if (w.settings.contact && (k == 0 || contactsOutdated(w))) {
    findContactsAhead(w, w.settings.dt - (k + 1) * h);
  }
  findSoftContacts(w);
  if (w.settings.method == Method::kDirect) prepareDirect(w);
  prepareConstraints(w, h);        // multipliers of the last substep, gaps and anchors at X^t
  solveConstraints(w, h, report);  // Delta X (52),(53)
}

// A scheme that the solve does not bear out is lowered and the substep made anew; the third time
// everything steps by the paper's.
void displaceBySchemes(World::Impl& w, int k, double h, StepReport& report) {
  w.contactsBefore = w.contacts.pairs;
  chooseSchemes(w);
  displaceAll(w, k, h, report);
  for (int again = 0; again < 3 && !report.notFinite && lowerSchemes(w, h); ++again) {
    if (again == 2) stepByPaper(w);
    rewind(w.bodies);
    w.contacts.pairs = w.contactsBefore;
    displaceAll(w, k, h, report);
  }
}

void finish(World::Impl& w, double h, StepReport& report) {
  const double restitution = w.settings.contact ? w.settings.contact->restitution : 0;
  if (restitution > 0) w.velocityBefore = w.bodies.velocity;
  if (isSecondOrder(w.settings)) {
    finishSecondOrder(w.bodies, w.loads, w.settings.gravity);
    projectVelocities(w);
  } else {
    finishVelocities(w.bodies, h);  // (43)-(46)
  }
  std::vector<bool> jumped;
  if (restitution > 0) jumped = restitute(w.contacts, w.bodies, restitution, w.flight(h));
  if (isSecondOrder(w.settings)) recordSchemes(w, jumped, report);
}

// A whole substep of a rival, from contacts found as for the other methods.
void substepOfRival(World::Impl& w, int k, double h, StepReport& report) {
  coast(w, h);
  if (w.settings.contact && (k == 0 || contactsOutdated(w))) {
    findContactsAhead(w, w.settings.dt - (k + 1) * h);
  }
  findSoftContacts(w);
  rivalSubstep(w, h, report);
  checkFinite(w, report);
  ++report.substeps;
}

void restore(World::Impl& w) {
  w.bodies.pose = w.last.pose;
  w.bodies.velocity = w.last.velocity;
  w.contacts.pairs.clear();
  w.softContacts.clear();
  undo(w.arms);
  forEachKind(w.kinds, [](auto& kind) {
    for (auto& lambda : kind.set.lambda) lambda = {};
  });
}

}  // namespace

StepReport World::step() {
  Impl& w = *impl_;
  const double h = w.substepLength();
  const bool isStatic = w.settings.stepping == Stepping::kStatic;
  StepReport report;
  if (w.settings.contact) w.takeShapes();
  w.last.pose = w.bodies.pose;
  w.last.velocity = w.bodies.velocity;
  drive(w.arms, w.bodies, w.settings.dt);  // (149)-(154)
  for (int k = 0; k < w.settings.substeps && !report.notFinite; ++k) {
    if (isStatic) bringToRest(w.bodies);
    if (isRival(w.settings.method)) {
      substepOfRival(w, k, h, report);
      continue;
    }
    isSecondOrder(w.settings) ? displaceBySchemes(w, k, h, report) : displaceAll(w, k, h, report);
    if (report.notFinite) break;
    finish(w, h, report);
    checkFinite(w, report);
    ++report.substeps;
  }
  if (isStatic) bringToRest(w.bodies);
  if (report.notFinite) restore(w);
  w.loads.assign(w.loads.size(), Load{});
  ++w.stepCount;
  return report;
}

}  // namespace physics
