// What a step skips, and what it does when it meets it.
#include "physics/effects/skip_inactive.h"

#include "physics/base/profile.h"
#include "physics/effects/sleep.h"
#include "physics/state/world_state.h"

namespace physics {
namespace {

bool isApart(const WorldState& w) { return w.local.groups.size() > 1; }

// Other groups may be before or after their step: wherever they are, from X^t to its end.
void placeAll(WorldState& w, std::span<const Pose> start, std::span<const Pose> target) {
  w.local.start.assign(start.begin(), start.end());
  w.local.end.assign(target.begin(), target.end());
  for (BodyId i = kWorldBody + 1; i < w.bodies.size(); ++i) {
    if (w.activeMask[i] != kInactive) continue;
    w.local.start[i] = w.last.pose[i];
    w.local.end[i] = w.ahead[i];
  }
}

bool notePair(WorldState& w, BodyId a, BodyId b) {
  if (w.activeMask[a] == kActive && w.activeMask[b] == kInactive) w.met.push_back({a, b});
  if (w.activeMask[b] == kActive && w.activeMask[a] == kInactive) w.met.push_back({b, a});
  return w.activeMask[a] == kActive || w.activeMask[b] == kActive;
}

std::span<const Manifold> ownOf(WorldState& w, std::span<const Manifold> found) {
  w.own.clear();
  for (const Manifold& manifold : found) {
    if (notePair(w, manifold.a, manifold.b)) w.own.push_back(manifold);
  }
  return w.own;
}

}  // namespace

bool skipsInactive(const WorldState& w) { return w.sleep.count > 0 || isApart(w); }

// Bodies::start is where backward Euler would have started.
std::span<const Pose> poseAtStart(const WorldState& w) {
  return w.bodies.second.empty() ? w.bodies.start : w.bodies.second.origin;
}

bool findContacts(WorldState& w, std::span<const Pose> target) {
  const double margin = w.settings.contact->margin;
  std::span<const Pose> start = poseAtStart(w);
  if (isApart(w)) {
    placeAll(w, start, target);
    start = w.local.start;
    target = w.local.end;
  }
  std::span<const Manifold> found = w.collider.find(start, target, margin);
  if (skipsInactive(w)) found = ownOf(w, found);
  if (!w.met.empty()) return false;
  update(w.contacts, found, w.bodies);
  profileScope("");
  return true;
}

// Points and links are looked at anew in every substep: their planes turn quickly.
bool findSoftContacts(WorldState& w) {
  if (!w.settings.contact || w.softCollider.empty()) return true;
  profileScope("soft_contact");
  const double margin = w.settings.contact->margin;
  const bool skips = skipsInactive(w);
  const std::span<const char> inactive = skips ? w.activeMask : std::span<const char>{};
  const auto touches = w.softCollider.find(poseAtStart(w), w.bodies.pose, margin, inactive);
  for (const SoftTouch& touch : touches) {
    if (skips) notePair(w, w.softCollider.element(touch.element).from, touch.body);
  }
  if (!w.met.empty()) return false;
  startSoftContacts(touches, w.softCollider, w.bodies, w.softContacts);
  return true;
}

void keepStart(WorldState& w) {
  if (w.sleep.count == 0 && (!stepsLocally(w.settings) || w.local.full)) return;
  w.kept.contacts = w.contacts.pairs;
  w.kept.history = w.bodies.second.history;
  w.kept.unresolved = w.stepper.unresolved;
  w.kept.bounded = w.stepper.bounded;
  forEachKind(w.kinds, [](auto& kind) {
    auto& set = kind.set;
    if (!set.active.empty()) set.kept.resize(set.lambda.size());
    for (const int k : set.active) set.kept[k] = set.lambda[k];
  });
}

void takeBack(WorldState& w) {
  for (const BodyId i : w.bodies.active) {
    w.bodies.start[i] = w.bodies.pose[i] = w.last.pose[i];
    const bool isDriven = w.bodies.motion[i] == Motion::kKinematic;  // arms may have done it
    if (!isDriven) w.bodies.velocity[i] = w.last.velocity[i];
  }
  w.contacts.pairs = w.kept.contacts;
  w.bodies.second.history = w.kept.history;
  w.stepper.unresolved = w.kept.unresolved;
  w.stepper.bounded = w.kept.bounded;
  forEachKind(w.kinds, [](auto& kind) {
    auto& set = kind.set;
    for (const int k : set.active) set.lambda[k] = set.kept[k];
  });
}

bool includeMet(WorldState& w, StepReport& report) {
  if (w.met.empty()) return false;
  takeBack(w);
  for (const auto& [here, there] : w.met) {
    callAwake(w.sleep, there);
    if (stepsLocally(w.settings)) w.local.joins.push_back({here, there});
  }
  w.met.clear();
  wakeCalled(w);
  ++report.work.madeAnew;
  return true;
}

}  // namespace physics
