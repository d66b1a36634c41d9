// The contacts of a step, and which islands look for them twice.
#include <algorithm>
#include <numeric>
#include <tuple>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

namespace {

// Pairs are looked at by all threads: what is found of one depends on no other.
std::span<const Found> findContacts(Model& w) {
  constexpr int kLeastPairs = 64;  // of a thread
  profileScope("broad_phase");
  const auto pairs =
      static_cast<int>(w.collider.prepare(w.bodies.pose, w.ahead, w.settings.contact->margin));
  profileScope("narrow_phase");
  w.workers.forEachChunk(pairs, kLeastPairs,
                         [&](int from, int to) { w.collider.lookAt(from, to); });
  const std::span<const Found> found = w.collider.gather();
  profileScope("contact");
  return found;
}

}  // namespace

// Contacts from the present poses to where the bodies would be at the end of the step. False: the
// look met bodies that sleep, which are awake now.
bool SmallSteps::Impl::lookOnce(Model& w) {
  Bodies& b = w.bodies;
  for (const BodyId i : b.active) {
    const double dt = halved[i] ? 0.5 * w.settings.dt : w.settings.dt;
    w.ahead[i] = b.pose[i];
    if (w.settings.gravity && b.motion[i] == Motion::kDynamic) {
      w.ahead[i].x += dt * dt * *w.settings.gravity;
    }
    displace(w.ahead[i], dt * b.velocity[i].v, dt * b.velocity[i].w);
  }
  if (!lookSoft(w)) return false;
  if (!w.touches) return true;
  const auto found = findContacts(w);
  if (w.sleep.count > 0) {
    const std::size_t called = w.sleep.called.size();
    for (const Found& f : found) {
      for (const BodyId i : {f.manifold->a, f.manifold->b}) callAwake(w.sleep, i);
    }
    if (w.sleep.called.size() > called) {
      (*wake)();
      return false;
    }
  }
  std::swap(contacts, before);
  keep(before, found, b, contacts);
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

// The bodies of islands with a fast one step now. False: there is none.
bool SmallSteps::Impl::chooseFast(Model& w) {
  const Bodies& b = w.bodies;
  if (!w.touches || w.settings.substepCount() < 2) return false;
  const double speed = w.settings.contact->margin / w.settings.dt;
  bool some = false;
  for (const BodyId i : b.active) {
    const Velocity& v = b.velocity[i];
    steps[i] = v.v.norm() + radius[i] * v.w.norm() > speed;
    some = some || steps[i];
  }
  if (some) spread(w);
  return some;
}

// What one body of an island does all of them do.
void SmallSteps::Impl::spread(Model& w) {
  const Bodies& b = w.bodies;
  islands = jointIslands(w);
  for (const KeptContact& c : contacts) join(b, islands, c.a, c.b);
  for (const SoftPair& pair : softPairs) joinSoft(w, pair);
  settle(islands, b.active);
  for (const BodyId i : b.active) {
    if (steps[i]) steps[islands[i]] = 1;
  }
  for (const BodyId i : b.active) steps[i] = steps[islands[i]];
}

// Bodies that one which made half of its step is about to meet make theirs now. False: there is
// none.
bool SmallSteps::Impl::chooseMet(Model& w) {
  for (const BodyId i : w.bodies.active) steps[i] = halved[i];
  spread(w);
  bool some = false;
  for (const BodyId i : w.bodies.active) {
    steps[i] = steps[i] && !halved[i];
    some = some || steps[i];
  }
  return some;
}

// Those that have yet to make the second half, or all of their step. False: there is none.
bool SmallSteps::Impl::choose(const Model& w, int parts) {
  bool some = false;
  for (const BodyId i : w.bodies.active) {
    steps[i] = halved[i] == (parts == 2);
    some = some || steps[i];
  }
  return some;
}

}  // namespace physics
