// What several kinds' cases are made of.
#pragma once

#include "physics/constraints/between.h"
#include "tests/physics/kind_cases.h"

namespace physics::testing {

inline constexpr double kFar = 0.15;  // from singular places: there differences lose their digits

inline Vec3 axis(Random& random) { return random.rotation(kPi) * Vec3::UnitX(); }

template <class Item>
Vec3 between(const Item& item, const Bodies& bodies) {
  return physics::between(bodies.pose, item.bodies, item.anchors);
}

template <class Item>
void anchorsApart(Item& item, Random& random, const Bodies& bodies) {
  do {
    item.anchors = {random.inBall(1), random.inBall(1)};
  } while (between(item, bodies).norm() < kFar);
}

template <class Item>
Item swapAnchors(Item item) {
  std::swap(item.anchors[0], item.anchors[1]);
  return item;
}

}  // namespace physics::testing
