// What contacts take from the shapes of two bodies.
#pragma once

#include <variant>

#include "physics/bodies/body.h"

namespace physics {

// Its contacts' normal is that of a face, and turns with it.
inline bool hasFaces(const Shape& shape) {
  return std::holds_alternative<Box>(shape) || std::holds_alternative<Convex>(shape) ||
         std::holds_alternative<Plane>(shape);
}

// Between two of these the normal joins the centres.
inline bool isBall(const Shape& shape) {
  return std::holds_alternative<Sphere>(shape) || std::holds_alternative<PointShape>(shape);
}

}  // namespace physics
