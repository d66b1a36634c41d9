// Contacts from step to step.
#include "physics/solver/kept_contact.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "physics/constraints/friction.h"

namespace physics {
namespace {

void take(const KeptContact& old, int m, KeptContact& fresh, int k) {
  fresh.lambda[k] = old.lambda[m];
  fresh.before[k] = old.before[m];
  fresh.held[k] = old.held[m];
}

// A point goes on from the one with its feature, else from the nearest on body a that none has:
// clipped corners change their names when faces slide past each other.
void match(const KeptContact& old, KeptContact& fresh) {
  unsigned taken = 0, found = 0;
  for (int k = 0; k < fresh.count; ++k) {
    for (int m = 0; m < old.count; ++m) {
      if (taken >> m & 1 || old.points[m].feature != fresh.points[k].feature) continue;
      take(old, m, fresh, k);
      taken |= 1u << m;
      found |= 1u << k;
      break;
    }
  }
  for (int k = 0; k < fresh.count; ++k) {
    if (found >> k & 1) continue;
    int nearest = -1;
    double best = std::numeric_limits<double>::infinity();
    for (int m = 0; m < old.count; ++m) {
      if (taken >> m & 1) continue;
      const double d = (old.points[m].coreA - fresh.points[k].coreA).squaredNorm();
      if (d < best) best = d, nearest = m;
    }
    if (nearest < 0) continue;
    take(old, nearest, fresh, k);
    taken |= 1u << nearest;
  }
  fresh.tangential = old.tangential;
  fresh.twist = old.twist;
  fresh.step = old.step;
  fresh.whole = old.whole;
}

void take(const Manifold& found, const Bodies& bodies, KeptContact& fresh) {
  fresh.a = found.a;
  fresh.b = found.b;
  fresh.key = found.pair;
  fresh.radial = found.radial;
  fresh.carried = found.carried;
  fresh.normal = fresh.carried ? found.normal : Vec3(bodies.pose[found.b].q * found.normal);
  fresh.friction = frictionBetween(bodies.friction[found.a], bodies.friction[found.b]);
  fresh.count = found.count;
  for (int k = 0; k < found.count; ++k) fresh.points[k] = found.points[k];
  fresh.lambda = {};
  fresh.before = {};
  fresh.held = {};
  fresh.tangential.setZero();
  fresh.twist = fresh.step = fresh.whole = 0;
}

// Its surfaces are where the collider told them to be, and it has as many points as these: within
// the step it may have come to others.
bool isAsBefore(const KeptContact& old, const Found& found) {
  return !found.isNew && old.carried && old.count == found.manifold->count;
}

constexpr int kLeastContacts = 32;  // of a thread

// Whether each is of the pair that it was of.
bool areSame(std::span<const KeptContact> contacts, std::span<const Found> found,
             Workers& workers) {
  if (contacts.size() != found.size()) return false;
  std::atomic<bool> same = true;
  workers.forEachChunk(static_cast<int>(found.size()), kLeastContacts, [&](int from, int to) {
    int i = from;
    while (i < to && contacts[i].key == found[i].manifold->pair) ++i;
    if (i < to) same = false;
  });
  return same;
}

void keepAll(std::span<const KeptContact> previous, std::span<const Found> found,
             const Bodies& bodies, Workers& workers, std::vector<KeptContact>& now) {
  const auto isBefore = [](const KeptContact& c, std::uint64_t key) { return c.key < key; };
  now.resize(found.size());
  workers.forEachChunk(static_cast<int>(found.size()), kLeastContacts, [&](int from, int to) {
    auto old =
        std::lower_bound(previous.begin(), previous.end(), found[from].manifold->pair, isBefore);
    for (int i = from; i < to; ++i) {
      const Manifold& m = *found[i].manifold;
      while (old != previous.end() && old->key < m.pair) ++old;
      const bool goesOn = old != previous.end() && old->key == m.pair;
      if (goesOn && isAsBefore(*old, found[i])) {
        now[i] = *old;
        continue;
      }
      take(m, bodies, now[i]);
      if (goesOn) match(*old, now[i]);
    }
  });
}

}  // namespace

// Where no pair came or went the others stay where they are.
void keep(std::span<const Found> found, const Bodies& bodies, Workers& workers,
          std::vector<KeptContact>& contacts, std::vector<KeptContact>& before) {
  if (!areSame(contacts, found, workers)) {
    std::swap(contacts, before);
    return keepAll(before, found, bodies, workers, contacts);
  }
  workers.forEachChunk(static_cast<int>(found.size()), kLeastContacts, [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      if (isAsBefore(contacts[i], found[i])) continue;
      const KeptContact old = contacts[i];
      take(*found[i].manifold, bodies, contacts[i]);
      match(old, contacts[i]);
    }
  });
}

void renew(const Manifold& found, const Bodies& bodies, KeptContact& contact) {
  const KeptContact old = contact;
  take(found, bodies, contact);
  match(old, contact);
}

Vec3 normalOf(const KeptContact& contact, std::span<const Pose> pose) {
  if (contact.carried) return pose[contact.b].q * contact.normal;
  if (contact.radial) {
    const Vec3 between = pose[contact.a].x - pose[contact.b].x;
    const double distance = between.norm();
    if (distance > 0) return between / distance;
  }
  return contact.normal;
}

double leastGapOf(const KeptContact& c, std::span<const Pose> pose) {
  const Vec3 n = normalOf(c, pose);
  const Pose &a = pose[c.a], &b = pose[c.b];
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < c.count; ++k) {
    const ContactPoint& shape = c.points[k];
    const Vec3 apart = (a.x + a.q * shape.coreA) - (b.x + b.q * shape.coreB);
    least = std::min(least, apart.dot(n) - (shape.radiusA + shape.radiusB));
  }
  return least;
}

ContactPair pairOf(const KeptContact& contact, double step) {
  ContactPair pair;
  pair.a = contact.a;
  pair.b = contact.b;
  pair.key = contact.key;
  pair.radial = contact.radial;
  pair.carried = contact.carried;
  pair.normal = contact.normal;
  pair.friction = contact.friction;
  pair.count = contact.count;
  const double scale = contact.step > 0 ? step / contact.step : 0;
  const double sum = KeptContact::sumOf(contact.lambda);
  for (int k = 0; k < contact.count; ++k) {
    pair.points[k].shape = contact.points[k];
    pair.points[k].normalTotal = scale * contact.lambda[k];
    if (sum > 0)
      pair.points[k].frictionTotal = scale * contact.lambda[k] / sum * contact.tangential;
  }
  return pair;
}

}  // namespace physics
