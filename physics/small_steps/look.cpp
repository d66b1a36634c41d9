// The contacts of a step.
#include <algorithm>
#include <atomic>
#include <numeric>
#include <tuple>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

namespace {

std::span<const Found> findContacts(Model& w, std::span<const double> push = {}) {
  return w.collider.look(w.bodies.pose, w.ahead, w.settings.contact->margin, push, w.workers);
}

}  // namespace

// Of a body against another, within this step: by its velocity, and what hits add.
Vec3 SmallSteps::Impl::wayInStep(const Model& w, const KeptContact& c) const {
  const std::vector<Velocity>& velocity = w.bodies.velocity;
  return w.settings.dt * (velocity[c.b].v - velocity[c.a].v) + pushed[c.b] - pushed[c.a];
}

// What moves by less than half of its thickness stays on its own side of what it meets.
double SmallSteps::Impl::ownSide(const KeptContact& c) const {
  return 0.5 * std::min(thickness[c.a], thickness[c.b]);
}

bool SmallSteps::Impl::goesFar(const Model& w, const KeptContact& c) const {
  const double least = ownSide(c);
  return wayInStep(w, c).squaredNorm() >= least * least;
}

// By body: how much further hits may take it than it is about to go, which is with what hits it;
// and on with that to what it touches, as far as the pushes of a substep reach. Of what goes less
// far nothing is to be known. What hits any of an articulation may fling all of it, whatever it
// meets: limbs turn about what has been stopped. False: there is no more.
bool SmallSteps::Impl::findPushes(Model& w) {
  const Bodies& b = w.bodies;
  const auto isPushed = [&](const KeptContact& c) {
    return isMovable(b, c.a) && isMovable(b, c.b);
  };
  const auto mayPush = [&](const KeptContact& c) {
    return (isPushed(c) || isJointed(c)) && goesFar(w, c);
  };
  std::fill(pushed.begin(), pushed.end(), Vec3::Zero());
  flung.assign(articulations.size(), 0);
  std::atomic<bool> any = false;
  w.workers.forEachChunk(static_cast<int>(contacts.size()), kLeastContacts, [&](int from, int to) {
    if (std::any_of(contacts.begin() + from, contacts.begin() + to, mayPush)) any = true;
  });
  bool some = false, more = any;
  for (int k = 0; k < kPositionSweeps && more; ++k) {
    more = false;
    for (const KeptContact& c : contacts) {
      if (!mayPush(c)) continue;
      const Vec3 n = normalOf(c, b.pose);
      const double closing = n.dot(wayInStep(w, c));
      if (!(closing > ownSide(c))) continue;
      some = true;
      for (const BodyId i : {c.a, c.b}) {
        const int articulation = articulationOf[i];
        if (articulation >= 0) flung[articulation] = std::max(flung[articulation], closing);
      }
      if (!isPushed(c)) continue;
      pushed[c.a] += closing * n;
      pushed[c.b] -= closing * n;
      more = true;
    }
  }
  if (!some) return false;
  for (std::size_t i = 0; i < pushed.size(); ++i) {
    const int articulation = articulationOf[i];
    push[i] = std::max(pushed[i].norm(), articulation >= 0 ? flung[articulation] : 0);
  }
  return true;
}

// Contacts of bodies that go far past each other: other features than those of the start will meet.
void SmallSteps::Impl::findSliding(Model& w) {
  std::atomic<bool> some = false;
  sliding.assign(contacts.size(), 0);
  w.workers.forEachChunk(static_cast<int>(contacts.size()), kLeastContacts, [&](int from, int to) {
    for (int k = from; k < to; ++k) {
      if (!goesFar(w, contacts[k])) continue;
      sliding[k] = 1;
      some = true;
    }
  });
  if (!some) sliding.clear();
}

// Surfaces that this look has found anew: the next one tells of them as of those of before.
void SmallSteps::Impl::renewFound(std::span<const Found> found, const Bodies& bodies) {
  const auto isBefore = [](const KeptContact& c, std::uint64_t key) { return c.key < key; };
  for (const Found& f : found) {
    if (!f.isNew) continue;
    const std::uint64_t key = f.manifold->pair;
    const auto kept = std::lower_bound(contacts.begin(), contacts.end(), key, isBefore);
    if (kept != contacts.end() && kept->key == key) physics::renew(*f.manifold, bodies, *kept);
  }
}

// Contacts from the present poses to where the bodies would be at the end of the step. False: the
// look met bodies that sleep, which are awake now.
bool SmallSteps::Impl::lookOnce(Model& w) {
  Bodies& b = w.bodies;
  const double dt = w.settings.dt;
  w.workers.forEachChunk(static_cast<int>(b.active.size()), kLeastBodies, [&](int from, int to) {
    for (const BodyId i : std::span(b.active).subspan(from, to - from)) {
      w.ahead[i] = b.pose[i];
      if (w.settings.gravity && b.motion[i] == Motion::kDynamic) {
        w.ahead[i].x += dt * dt * *w.settings.gravity;
      }
      displace(w.ahead[i], dt * b.velocity[i].v, dt * b.velocity[i].w);
    }
  });
  if (!lookSoft(w)) return false;
  if (!w.touches) return true;
  const auto found = findContacts(w);
  if (w.sleep.count > 0) {
    const std::size_t called = w.sleep.called.size();
    for (const Found& f : found) {
      for (const BodyId i : {f.manifold->a, f.manifold->b}) callAwake(w.sleep, i);
    }
    if (w.sleep.called.size() > called) {
      renewFound(found, b);
      (*wake)();
      return false;
    }
  }
  keep(found, b, w.workers, contacts, before);
  if (findPushes(w)) keep(findContacts(w, push), b, w.workers, contacts, before);
  findSliding(w);
  return true;
}

// The same of points and links: which of them may meet a body in this step.
bool SmallSteps::Impl::lookSoft(Model& w) {
  softPairs.clear();
  if (!w.settings.contact || w.softCollider.empty()) return true;
  const bool some = w.sleep.count > 0;
  if (some) w.takeActiveMask();
  const auto leftOut = some ? std::span<const char>(w.activeMask) : std::span<const char>{};
  const std::size_t called = w.sleep.called.size();
  for (const SoftTouch& touch :
       w.softCollider.find(w.bodies.pose, w.ahead, w.settings.contact->margin, leftOut)) {
    const bool again = !softPairs.empty() && softPairs.back().element == touch.element &&
                       softPairs.back().body == touch.body;
    if (!again) softPairs.push_back({touch.element, touch.body});
    const SoftElement& element = w.softCollider.element(touch.element);
    for (const BodyId i : {element.from, element.to, touch.body}) callAwake(w.sleep, i);
  }
  if (w.sleep.called.size() == called) return true;
  (*wake)();
  return false;
}

// Contacts of points and links from the batches, in the collider's order. Its own order among those
// of an element and a body stays: std::stable_sort would allocate.
void SmallSteps::Impl::gatherSoft(Model& w) {
  if (w.softCollider.empty()) return;
  gathered.assign(w.softContacts.begin(), w.softContacts.end());
  for (std::size_t k = 0; k < batchCount; ++k) {
    gathered.insert(gathered.end(), batches[k].soft.begin(), batches[k].soft.end());
  }
  gatherOrder.resize(gathered.size());
  std::iota(gatherOrder.begin(), gatherOrder.end(), 0);
  std::sort(gatherOrder.begin(), gatherOrder.end(), [&](int i, int j) {
    const SoftContact &a = gathered[i], &b = gathered[j];
    return std::tie(a.element, a.body, i) < std::tie(b.element, b.body, j);
  });
  w.softContacts.clear();
  for (const int i : gatherOrder) w.softContacts.push_back(gathered[i]);
}

void SmallSteps::Impl::look(Model& w) {
  if (!w.touches && w.softCollider.empty()) return;
  while (!lookOnce(w)) {
  }
}

}  // namespace physics
