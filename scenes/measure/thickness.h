// How thick a body is: what the depth of an overlap is held against.
#pragma once

#include "physics/bodies/shape.h"

namespace scenes {

// The diameter of the largest sphere about the centre of mass that fits in [m]; infinite for what
// has no inside to measure against: a plane, a point.
double thicknessOf(const physics::Shape& shape);

}  // namespace scenes
