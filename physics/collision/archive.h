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
  auto& [a, b, radial, carried, pair, normal, count, points] = manifold;
  to(a, b, radial, carried, pair, normal, count);
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

// What it is was added, and its motion is that of the last look.
inline void archive(Archive& a, Item& item) {
  auto& [travel, turn, push, move, body, movable, rests, isPlane, isPart, x, R, solid, inBody] =
      item;
  a(travel, rests);
}

inline void archive(Archive& to, Watch& watch) {
  auto& [a, b, finding, count, known, isNew, more, calls, travel, distance, reach, n] = watch;
  to(a, b, finding, count, known, isNew, more, calls, travel, distance, reach, n);
}

}  // namespace collision
}  // namespace physics
