#pragma once

#include <limits>

namespace physics::testing {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace physics::testing
