// The narrow phase: two solids at a relative pose in, one manifold out. Pure functions.
#pragma once

#include "physics/collision/collider.h"
#include "physics/collision/solid.h"

namespace physics::collision {

// a.kind must not be later than b.kind. When the solids are within `reach`, fills `out` with the
// points whose gap is at most `keep` and returns the distance (negative: depth along the normal);
// otherwise out.count is 0 and the answer is a lower bound of the distance, above `reach`.
double touch(const Solid& a, const Solid& b, const Relative& pose, double reach, double keep,
             Manifold& out);

// Signed distance. Exact for separated solids, and for overlapping ones but for cylinders, where it
// is the depth along the best direction found. b may be of an earlier kind than a.
double signedDistance(const Solid& a, const Solid& b, const Relative& pose);

}  // namespace physics::collision
