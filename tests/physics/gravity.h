#pragma once

namespace physics::testing {

inline constexpr double kGravity = 9.81;  // m/s²

}  // namespace physics::testing
