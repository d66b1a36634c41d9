// How wrong a constraint stands at the present poses.
#pragma once

#include <algorithm>
#include <cmath>

#include "physics/constraints/constraint.h"

namespace physics {

// |c|, or the violated side of a bound, in the unit of the kind's rows.
template <class C>
double sizeOfError(const C& item, const Bodies& bodies, double dt) {
  if constexpr (requires { item.relativeError(bodies.pose); }) {
    return item.relativeError(bodies.pose);
  }
  Row<C::kBodies, C::kRows> row;
  item.evaluate({bodies.pose, bodies.start, dt}, row);
  const double size = row.c.norm();
  if (std::isfinite(row.high) && row.high <= 0) return std::max(row.c[0], 0.0);  // c <= 0 holds
  if (std::isfinite(row.low) && row.low >= 0) return std::max(-row.c[0], 0.0);   // c >= 0 holds
  return size;
}

}  // namespace physics
