// The joints that the direct method takes as rows.
#pragma once

#include "physics/sweep/sweep_model.h"

namespace physics {

template <class C>
constexpr bool isJoint() {
  return !Force<C> && C::kBodies == 2;
}

template <class F>
void forEachJoint(SweepModel& world, F&& f) {
  std::size_t next = 0;
  forEachKind(world.kinds, [&](auto& kind) {
    auto& set = kind.set;
    if constexpr (isJoint<typename std::decay_t<decltype(kind)>::Item>()) {
      for (const int k : set.active) {
        if (isSolvedDirectly(set.items[k])) f(set.items[k], set.lambda[k], set.tuned[k], next++);
      }
    }
  });
}

}  // namespace physics
