// Contact: keeping manifolds over steps, and the geometry of a point.
#include "physics/constraints/contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/constraints/friction.h"

namespace physics {
namespace {

// The old point that a fresh one goes on from: the same feature, else the nearest on body a that no
// fresh point has the feature of. Clipped corners change their names when faces slide past each
// other.
int ancestorOf(const ContactPair& old, const ContactPair& fresh, int k, unsigned taken) {
  for (int m = 0; m < old.count; ++m) {
    if (old.points[m].shape.feature == fresh.points[k].shape.feature) return m;
  }
  int nearest = -1;
  double best = std::numeric_limits<double>::infinity();
  for (int m = 0; m < old.count; ++m) {
    if (taken & (1u << m)) continue;
    const double distance = (old.points[m].shape.coreA - fresh.points[k].shape.coreA).squaredNorm();
    if (distance < best) best = distance, nearest = m;
  }
  return nearest;
}

void keepState(const ContactPair& old, ContactPair& fresh) {
  unsigned taken = 0;  // bit m: old point m goes on somewhere
  for (int k = 0; k < fresh.count; ++k) {
    for (int m = 0; m < old.count; ++m) {
      if (old.points[m].shape.feature == fresh.points[k].shape.feature) taken |= 1u << m;
    }
  }
  for (int k = 0; k < fresh.count; ++k) {
    const int m = ancestorOf(old, fresh, k, taken);
    if (m < 0) continue;
    taken |= 1u << m;
    const ContactPoint shape = fresh.points[k].shape;
    fresh.points[k] = old.points[m];
    fresh.points[k].shape = shape;
  }
}

ContactPair fromManifold(const Manifold& manifold, const Bodies& bodies) {
  ContactPair pair;
  pair.a = manifold.a;
  pair.b = manifold.b;
  pair.key = manifold.pair;
  pair.radial = manifold.radial;
  pair.carried = manifold.carried;
  pair.normal = pair.carried ? manifold.normal : Vec3(bodies.pose[pair.b].q * manifold.normal);
  pair.friction = frictionBetween(bodies.friction[pair.a], bodies.friction[pair.b]);
  pair.frictional = pair.friction.staticCoefficient > 0 || bodies.general;
  pair.count = manifold.count;
  for (int k = 0; k < manifold.count; ++k) pair.points[k].shape = manifold.points[k];
  return pair;
}

}  // namespace

void update(Contacts& contacts, std::span<const Manifold> manifolds, const Bodies& bodies) {
  std::swap(contacts.pairs, contacts.previous);
  contacts.pairs.clear();
  std::size_t old = 0;
  for (const Manifold& manifold : manifolds) {
    ContactPair fresh = fromManifold(manifold, bodies);
    while (old < contacts.previous.size() && contacts.previous[old].key < fresh.key) ++old;
    if (old < contacts.previous.size() && contacts.previous[old].key == fresh.key) {
      keepState(contacts.previous[old], fresh);
      fresh.step = contacts.previous[old].step;
    }
    contacts.pairs.push_back(fresh);
  }
}

bool isLoaded(const ContactPair& pair) {
  return std::any_of(pair.points.begin(), pair.points.begin() + pair.count,
                     [](const ContactPointState& p) { return p.normalTotal > 0; });
}

Vec3 impulseOf(const ContactPair& pair) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < pair.count; ++k) {
    sum += pair.points[k].normalTotal * pair.points[k].normal + pair.points[k].frictionTotal;
  }
  return sum;
}

Vec3 normalOf(const ContactPair& pair, std::span<const Pose> pose) {
  const Pose &a = pose[pair.a], &b = pose[pair.b];
  if (pair.carried) return b.q * pair.normal;
  if (pair.radial) {
    const Vec3 between = a.x - b.x;
    const double distance = between.norm();
    if (distance > 1e-9) return between / distance;  // 1e7 roundings at 1 m: a direction
  }
  return pair.normal;
}

Vec3 pointOf(const ContactPair& pair, int k, std::span<const Pose> pose) {
  const ContactPoint& shape = pair.points[k].shape;
  const Pose& a = pose[pair.a];
  return a.x + a.q * shape.coreA - shape.radiusA * normalOf(pair, pose);
}

double gapOf(const ContactPair& pair, int k, std::span<const Pose> pose) {
  const ContactPoint& shape = pair.points[k].shape;
  const Pose& b = pose[pair.b];
  const Vec3 onB = b.x + b.q * shape.coreB;
  return (pointOf(pair, k, pose) - onB).dot(normalOf(pair, pose)) - shape.radiusB;
}

}  // namespace physics
