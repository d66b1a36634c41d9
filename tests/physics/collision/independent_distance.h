// The signed distance of two shapes, computed a second time in long double: separated cores by
// Wolfe's nearest point of the Minkowski difference, overlapping ones by all separating directions
// of polytopes (cylinders between an inscribed and a circumscribed prism).
#pragma once

#include "physics/collision/collider.h"

namespace physics::testing {

struct Bounds {
  double low = 0, high = 0;     // the signed distance lies between [m]
  Vec3 normal = Vec3::UnitY();  // from b to a, of `low`
};

// Not for two planes. b may be a plane, a not.
Bounds independentDistance(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB);

// The same of a point and a shape.
Bounds independentDistance(const Vec3& point, const Shape& shape, const Pose& pose);

}  // namespace physics::testing
