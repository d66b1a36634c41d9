// How thick a body is.
#include "scenes/measure/thickness.h"

#include <algorithm>
#include <limits>

#include "physics/bodies/compound.h"

namespace scenes {

double thicknessOf(const physics::Shape& shape) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (const auto* box = std::get_if<physics::Box>(&shape)) return box->size.minCoeff();
  if (const auto* sphere = std::get_if<physics::Sphere>(&shape)) return 2 * sphere->radius;
  if (const auto* capsule = std::get_if<physics::Capsule>(&shape)) return 2 * capsule->radius;
  if (const auto* cylinder = std::get_if<physics::Cylinder>(&shape)) {
    return std::min(2 * cylinder->radius, cylinder->length);
  }
  if (const auto* several = std::get_if<physics::Compound>(&shape)) {
    double thinnest = kInfinity;
    for (const physics::Part& part : several->parts->list) {
      thinnest = std::min(thinnest, thicknessOf(part.shape));
    }
    return thinnest;
  }
  const auto* convex = std::get_if<physics::Convex>(&shape);
  if (convex == nullptr) return kInfinity;
  double nearest = kInfinity;
  for (const physics::Hull::Face& face : convex->hull->faces) {
    nearest = std::min(nearest, face.offset);
  }
  return 2 * nearest;
}

}  // namespace scenes
