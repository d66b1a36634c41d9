// The words every physics file speaks: vectors, ids, poses and the check on callers.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace physics {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;  // unit, Hamilton convention: r = q r0 q̄  (4)

// Index of a body in its World. Body 0 is the world itself: static, at the origin, without a shape.
using BodyId = std::int32_t;
constexpr BodyId kWorldBody = 0;

// Position of the centre of mass [m] and orientation; the configuration X of (2).
struct Pose {
  Vec3 x = Vec3::Zero();
  Quat q = Quat::Identity();
};

// Linear [m/s] and angular [rad/s] velocity, world frame; (3).
struct Velocity {
  Vec3 v = Vec3::Zero();
  Vec3 w = Vec3::Zero();
};

// Throws std::invalid_argument when a caller breaks an interface's promise. Always on.
inline void require(bool condition, const std::string& expectation) {
  if (!condition) throw std::invalid_argument(expectation);
}
inline void require(bool condition, const char* expectation) {
  if (!condition) throw std::invalid_argument(expectation);
}

}  // namespace physics
