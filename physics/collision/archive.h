// What the collider knows of a pair from one look to the next.
#pragma once

#include "physics/base/archive.h"
#include "physics/collision/watch.h"

namespace physics {

inline void archive(Archive& a, ContactPoint& point) {
  auto& [coreA, coreB, radiusA, radiusB, feature] = point;
  a(coreA, coreB, radiusA, radiusB, feature);
}

inline void archive(Archive& to, Manifold& manifold) {
  auto& [a, b, radial, carried, pair, normal, count, isNew, points] = manifold;
  to(a, b, radial, carried, pair, normal, count, isNew);
  to.first(count, points);
}

namespace collision {

inline void archive(Archive& a, Relative& pose) {
  auto& [R, t] = pose;
  a(R, t);
}

inline void archive(Archive& a, Bounds& bounds) {
  auto& [low, high] = bounds;
  a(low, high);
}

// Its motion; what it is was added.
inline void archive(Archive& a, Item& item) {
  auto& [travel, turn, move, body, movable, rests, isPlane, isPart, x, R, solid, inBody] = item;
  a(travel, turn, move, rests, x, R);
}

inline void archive(Archive& to, Watch& watch) {
  auto& [a, b, finding, count, known, isNew, more, calls, travel, distance, reach, n] = watch;
  to(a, b, finding, count, known, isNew, more, calls, travel, distance, reach, n);
}

inline void archive(Archive& a, Finding& finding) {
  auto& [pose, manifold, more] = finding;
  a(pose, manifold, more);
}

}  // namespace collision
}  // namespace physics
