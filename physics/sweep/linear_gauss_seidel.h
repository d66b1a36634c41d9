// Linear Gauss-Seidel (51): errors, gradients and resistances are those of X^{t+1}, the errors
// follow the displacement to first order, and the sum of the displacements is applied at the end.
// Beside the non-linear method (52) it shows what linearised rotations cost (4.1, NOTES 3.5).
#pragma once

#include <array>
#include <vector>

#include "physics/bodies/body.h"
#include "physics/constraints/friction.h"
#include "physics/constraints/frozen_row.h"

namespace physics {

// One direction at one contact point: rigid bodies a and b, or a link's two points and a body.
struct FrozenContact {
  std::array<BodyId, 3> bodies{};
  std::array<Vec3, 3> linear{}, angular{};  // J
  double c = 0, resistance = 0, total = 0;
};

// The three directions of a contact point: the normal, and two for friction.
struct FrozenPoint {
  std::array<FrozenContact, 3> rows;
  Friction friction;
};

struct LinearSystem {
  std::vector<FrozenPoint> points;
  std::vector<DeltaX> moved;  // by body, the displacement so far
};

}  // namespace physics
