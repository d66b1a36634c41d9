// Falling asleep, and waking.
#include "physics/effects/sleep.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "physics/base/sorted.h"
#include "physics/model/factors.h"
#include "physics/model/islands.h"
#include "physics/motion/second_order.h"
#include "physics/rivals/rival.h"
#include "physics/state/world_state.h"

namespace physics {
namespace {

bool isSlow(const Bodies& bodies, BodyId i, double speed) {
  const Velocity& velocity = bodies.velocity[i];
  if (bodies.motion[i] == Motion::kKinematic) return velocity.v.isZero(0) && velocity.w.isZero(0);
  const double share = bodies.inertia[i].maxCoeff() / bodies.mass[i];
  return velocity.v.squaredNorm() + share * velocity.w.squaredNorm() < speed * speed;
}

// True where some body has been slow for long enough.
bool countStill(WorldState& w, int enough) {
  bool any = false;
  for (const BodyId i : w.bodies.active) {
    int& still = w.sleep.still[i];
    still = isSlow(w.bodies, i, w.settings.sleep->speed) ? std::min(still + 1, enough) : 0;
    any = any || still == enough;
  }
  forEachOverTime(w.kinds, [&](const auto& item) {
    if (!std::isfinite(nextPoint(*item.factor.table, w.time()))) return;
    for (const BodyId i : item.bodies) w.sleep.still[i] = 0;
  });
  for (const DrivenArm& arm : w.arms) {  // it may be told to move at any time
    for (const BodyId i : arm.bodies) w.sleep.still[i] = 0;
  }
  return any;
}

// By everything that is watched: what may touch soon does not sleep apart.
Islands watchedIslands(WorldState& w) {
  Islands islands = jointIslands(w);
  for (const ContactPair& pair : w.contacts.pairs) join(w.bodies, islands, pair.a, pair.b);
  for (const KeptContact& c : w.small.contacts()) join(w.bodies, islands, c.a, c.b);
  for (const SoftContact& c : w.softContacts) {
    join(w.bodies, islands, c.from, c.to);
    join(w.bodies, islands, moverOf(w.bodies, c.from, c.to), c.body);
  }
  settle(islands, w.bodies.active);
  return islands;
}

// The bodies of islands that have been slow for long enough, in order.
std::vector<BodyId> restingBodies(const WorldState& w, const Islands& islands, int enough) {
  std::vector<char> rests(islands.size(), 1);
  for (const BodyId i : w.bodies.active) {
    if (w.sleep.still[i] < enough) rests[islands[i]] = 0;
  }
  std::vector<BodyId> bodies;
  for (const BodyId i : w.bodies.active) {
    if (rests[islands[i]]) bodies.push_back(i);
  }
  return bodies;
}

void stop(WorldState& w, BodyId i) {
  Bodies& b = w.bodies;
  b.velocity[i] = {};
  b.start[i] = w.ahead[i] = w.last.pose[i] = b.pose[i];
  w.last.velocity[i] = {};
  b.shift[i].setZero();
  b.freeTurn[i].setZero();
  if (!b.second.empty()) b.second.origin[i] = b.second.before[i] = b.pose[i];
  forgetPast(b.second, i);
}

constexpr auto byKey = [](const auto& p, const auto& q) { return p.key < q.key; };

template <class Pair>
bool isAsleep(const WorldState& w, const Pair& pair) {
  return w.sleep.asleep[pair.a] || w.sleep.asleep[pair.b];
}

void makeRoom(Sleep& sleep, std::size_t bodies) {
  sleep.still.resize(bodies, 0);
  sleep.asleep.resize(bodies, 0);
  sleep.island.resize(bodies, kWorldBody);
}

}  // namespace

// What steps from now on, and what only stays in it for its turn or its gravity.
void listAwake(WorldState& w) {
  const auto isAwake = [&](BodyId i) { return w.sleep.count == 0 || !w.sleep.asleep[i]; };
  Bodies& b = w.bodies;
  b.active.clear();
  b.anisotropic.clear();
  w.turning = 0;
  for (BodyId i = kWorldBody + 1; i < b.size(); ++i) {
    if (b.motion[i] == Motion::kStatic || !isAwake(i)) continue;
    b.active.push_back(i);
    const Vec3& inverse = b.inverseInertia[i];
    w.turning += !inverse.isZero(0);
    if (inverse.x() != inverse.y() || inverse.y() != inverse.z()) b.anisotropic.push_back(i);
  }
  forEachKind(w.kinds, [&](auto& kind) {
    auto& set = kind.set;
    set.active.clear();
    for (std::size_t k = 0; k < set.items.size(); ++k) {
      const BodyId mover = moverOf(set.items[k], b);
      if (isAwake(mover)) set.active.push_back(static_cast<int>(k));
    }
  });
  w.joints = JointSystem{};
  w.local.groups.clear();
  w.local.full = false;
  w.takeActiveMask();
}

bool sleeps(const Settings& settings) {
  return settings.sleep && settings.leavesOut && settings.stepping != Stepping::kStatic &&
         !isRival(settings.method) && settings.method != Method::kLinearGaussSeidel;
}

void fallAsleep(WorldState& w, StepReport& report) {
  if (!sleeps(w.settings)) return;
  makeRoom(w.sleep, w.bodies.pose.size());
  const int enough =
      std::max(1, static_cast<int>(std::ceil(w.settings.sleep->time / w.settings.dt)));
  report.work.restSpeeds += static_cast<std::int64_t>(w.bodies.active.size());
  if (countStill(w, enough)) {
    const Islands islands = watchedIslands(w);
    const std::vector<BodyId> resting = restingBodies(w, islands, enough);
    for (const BodyId i : resting) {
      w.sleep.asleep[i] = 1;
      w.sleep.island[i] = islands[i];
      stop(w, i);
    }
    w.sleep.count += static_cast<int>(resting.size());
    if (!resting.empty()) {
      if (w.touches) w.collider.rest(resting, w.bodies.pose);
      const auto sleeps = [&](const auto& pair) { return isAsleep(w, pair); };
      carry(w.contacts.pairs, w.sleep.contacts, byKey, sleeps);
      carry(w.small.contacts(), w.small.sleeping, byKey, sleeps);
      std::erase_if(w.softContacts, [&](const SoftContact& c) {
        return w.sleep.asleep[moverOf(w.bodies, c.from, c.to)] != 0;
      });
      listAwake(w);
    }
  }
  report.asleep = w.sleep.count;
}

void wakeCalled(WorldState& w) {
  if (w.sleep.called.empty()) return;
  std::vector<char> wakes(w.bodies.pose.size(), 0);  // by an island's first body
  for (const BodyId body : w.sleep.called) wakes[w.sleep.island[body]] = 1;
  w.sleep.called.clear();
  std::vector<BodyId> woken;
  for (BodyId i = kWorldBody + 1; i < w.bodies.size(); ++i) {
    if (w.sleep.asleep[i] && wakes[w.sleep.island[i]]) woken.push_back(i);
  }
  for (const BodyId i : woken) w.sleep.asleep[i] = w.sleep.still[i] = 0;
  w.sleep.count -= static_cast<int>(woken.size());
  if (w.touches) w.collider.wake(woken);
  const auto isAwake = [&](const auto& pair) { return !isAsleep(w, pair); };
  carry(w.sleep.contacts, w.contacts.pairs, byKey, isAwake);
  carry(w.small.sleeping, w.small.contacts(), byKey, isAwake);
  listAwake(w);
}

}  // namespace physics
