// First touch of two moving solids, by conservative advancement.
#pragma once

#include <optional>

#include "physics/collision/solid.h"

namespace physics::collision {

// A body's way through one step: straight, and turning the short way from start to end.
struct Way {
  Pose start, end;
};
Pose along(const Way& way, double part);  // part 0 ... 1

// The part of the step after which the solids are within `near`, or none when they never are.
// `calls` counts distance evaluations. a.kind must not be later than b.kind, and b not a plane.
std::optional<double> firstTouch(const Solid& a, const Way& wayA, const Solid& b, const Way& wayB,
                                 double near, int& calls);

}  // namespace physics::collision
