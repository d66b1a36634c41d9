// Local substeps: which islands step together, from contacts found once.
#include "physics/effects/local_substeps.h"

#include <algorithm>
#include <cmath>

#include "physics/constraints/constraint_response.h"
#include "physics/effects/skip_inactive.h"
#include "physics/effects/sleep.h"
#include "physics/motion/second_order.h"
#include "physics/state/world_state.h"

namespace physics {
namespace {

void makeRoom(WorldState& w) {
  const auto size = w.bodies.pose.size();
  Local& local = w.local;
  if (local.wanted.size() == size) return;
  local.asked.resize(size, 1);
  for (auto* list : {&local.wanted, &local.substeps, &local.last}) {
    list->assign(size, w.settings.substepCount());
  }
  local.calm.assign(size, 0);
}

// Where bodies are at the end of the step if nothing touches them.
void lookAhead(WorldState& w) {
  const double dt = w.settings.dt;
  const Vec3 fall = dt * dt * w.settings.gravity.value_or(Vec3::Zero());
  for (const BodyId i : w.bodies.active) {
    w.bodies.start[i] = w.ahead[i] = w.bodies.pose[i];
    if (!w.bodies.second.empty()) w.bodies.second.origin[i] = w.bodies.pose[i];
    displace(w.ahead[i], dt * w.bodies.velocity[i].v, dt * w.bodies.velocity[i].w);
    if (w.bodies.motion[i] == Motion::kDynamic) w.ahead[i].x += fall;
  }
}

// All contacts of the step; what sleeps and is touched wakes.
void findAll(WorldState& w) {
  w.local.groups.clear();
  while (w.touches && !findContacts(w, w.ahead)) {
    for (const auto& [here, there] : w.met) callAwake(w.sleep, there);
    w.met.clear();
    wakeCalled(w);
    keepStart(w);
    lookAhead(w);
  }
}

// The island's number is the largest that one of its bodies wants.
void numberIslands(WorldState& w) {
  Local& local = w.local;
  for (const BodyId i : w.bodies.active) local.substeps[i] = 1;
  for (const BodyId i : w.bodies.active) {
    int& most = local.substeps[local.islands[i]];
    most = std::max({most, local.wanted[i], std::min(local.asked[i], w.settings.substepCount())});
  }
  for (const BodyId i : w.bodies.active) {
    local.substeps[i] = local.substeps[local.islands[i]];
    if (local.substeps[i] != local.last[i]) forgetPast(w.bodies.second, i);
  }
}

Group& groupOf(WorldState& w, int substeps) {
  std::vector<Group>& groups = w.local.groups;
  const auto at = std::find_if(groups.begin(), groups.end(),
                               [&](const Group& group) { return group.substeps == substeps; });
  if (at != groups.end()) return *at;
  groups.emplace_back().substeps = substeps;
  return groups.back();
}

void share(WorldState& w) {
  const std::vector<int>& substeps = w.local.substeps;
  for (const BodyId i : w.bodies.active) {
    Group& group = groupOf(w, substeps[i]);
    group.bodies.push_back(i);
    group.turning += !w.bodies.inverseInertia[i].isZero(0);
  }
  for (const BodyId i : w.bodies.anisotropic) groupOf(w, substeps[i]).anisotropic.push_back(i);
  std::size_t kindIndex = 0;
  forEachKind(w.kinds, [&](auto& kind) {
    for (const int k : kind.set.active) {
      const BodyId mover = moverOf(kind.set.items[k], w.bodies);
      if (isMovable(w.bodies, mover)) groupOf(w, substeps[mover]).items[kindIndex].push_back(k);
    }
    ++kindIndex;
  });
  for (const ContactPair& pair : w.contacts.pairs) {
    const BodyId body = isMovable(w.bodies, pair.a) ? pair.a : pair.b;
    groupOf(w, substeps[body]).contacts.push_back(pair);
  }
  std::sort(w.local.groups.begin(), w.local.groups.end(),
            [](const Group& p, const Group& q) { return p.substeps < q.substeps; });
}

// The factor's layout of last step's groups, where they are the same.
void keepLayouts(std::vector<Group>& old, std::vector<Group>& groups) {
  for (Group& group : groups) {
    for (Group& before : old) {
      if (before.items == group.items) std::swap(before.joints, group.joints);
    }
  }
}

void exchange(WorldState& w, Group& group) {
  w.bodies.active.swap(group.bodies);
  w.bodies.anisotropic.swap(group.anisotropic);
  std::swap(w.turning, group.turning);
  w.contacts.pairs.swap(group.contacts);
  w.softContacts.swap(group.softContacts);
  std::swap(w.joints, group.joints);
  std::size_t kindIndex = 0;
  forEachKind(w.kinds, [&](auto& kind) { kind.set.active.swap(group.items[kindIndex++]); });
}

}  // namespace

// Islands of small steps take as many as they need without being asked.
bool stepsLocally(const Settings& settings) {
  return settings.localSubsteps && settings.leavesOut && settings.substepCount() > 1 &&
         settings.stepping != Stepping::kStatic &&
         (settings.method == Method::kNonlinearGaussSeidel || settings.method == Method::kDirect ||
          (settings.method == Method::kSmallSteps && !settings.takesSmallSteps()));
}

void joinAll(WorldState& w) {
  Islands& islands = w.local.islands;
  islands = jointIslands(w);
  for (const ContactPair& pair : w.contacts.pairs) join(w.bodies, islands, pair.a, pair.b);
  for (const auto& [a, b] : w.local.joins) join(w.bodies, islands, a, b);
  if (w.settings.contact && !w.softCollider.empty()) {
    const double margin = w.settings.contact->margin;
    for (const SoftTouch& touch : w.softCollider.find(w.bodies.pose, w.ahead, margin)) {
      const SoftElement& element = w.softCollider.element(touch.element);
      join(w.bodies, islands, element.from, element.to);
      join(w.bodies, islands, moverOf(w.bodies, element.from, element.to), touch.body);
    }
  }
  settle(islands, w.bodies.active);
}

void takeGroups(WorldState& w) {
  if (!stepsLocally(w.settings)) return;
  makeRoom(w);
  if (w.local.full) return w.local.groups.clear();
  lookAhead(w);
  w.takeActiveMask();
  std::vector<Group> old;
  old.swap(w.local.groups);
  findAll(w);
  joinAll(w);
  numberIslands(w);
  share(w);
  keepLayouts(old, w.local.groups);
  for (const BodyId i : w.bodies.active) w.activeMask[i] = kInactive;
}

void enter(WorldState& w, Group& group) {
  exchange(w, group);
  w.substeps = group.substeps;
  for (const BodyId i : w.bodies.active) w.activeMask[i] = kActive;
}

void leave(WorldState& w, Group& group) {
  for (const BodyId i : w.bodies.active) {
    w.activeMask[i] = kInactive;
    w.ahead[i] = w.bodies.pose[i];  // where the groups after this one find it
  }
  exchange(w, group);
  w.substeps = w.settings.substepCount();
}

void leaveGroups(WorldState& w) {
  if (w.local.groups.empty()) return;
  w.contacts.pairs.clear();
  w.softContacts.clear();
  std::vector<const ContactPair*> together;
  for (Group& group : w.local.groups) {
    for (const ContactPair& pair : group.contacts) together.push_back(&pair);
    for (const SoftContact& contact : group.softContacts) w.softContacts.push_back(contact);
  }
  std::sort(together.begin(), together.end(), [](auto* p, auto* q) { return p->key < q->key; });
  for (const ContactPair* pair : together) w.contacts.pairs.push_back(*pair);
}

}  // namespace physics
