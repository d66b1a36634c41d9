// Free motion of every body over a substep, (28)-(31), with the gyroscopic torque where it does
// anything.
#pragma once

#include <optional>
#include <span>

#include "physics/bodies/body.h"

namespace physics {

// A torque-free turn of a body with principal moments `inertia` over dt, in the body frame.
//   M = I Omega;  M' = exp(-h Omega_m) M,  Omega_m = I^-1 (M + M')/2
// This is the implicit midpoint of NOTES 3.1 with the exact rotation in place of its linear part:
// M' is M turned, so the angular momentum in the world is kept, and turned about Omega_m, so the
// energy is kept too. What spins so fast that this has no solution near by turns in several parts.
struct FreeTurn {
  Vec3 mean = Vec3::Zero();   // Omega_m [rad/s]
  Vec3 after = Vec3::Zero();  // Omega' = I^-1 M' [rad/s]
  bool converged = true;      // false: Omega is kept as it was
};
//
// With `end` = 1 in place of 1/2, M' alone: I Omega_m = M', the backward Euler step, which keeps
// the angular momentum and loses energy.
FreeTurn freeTurn(const Vec3& inertia, const Vec3& omega, double dt, double end = 0.5);
// The same, where about what Omega_m is is known.
FreeTurn freeTurn(const Vec3& inertia, const Vec3& omega, double dt, double end, const Vec3& guess);

// External loads of a step, world frame.
struct Load {
  Vec3 force = Vec3::Zero();   // N
  Vec3 torque = Vec3::Zero();  // N m
};

// Moves bodies.pose from bodies.start over dt and sets velocities, shifts and free turns to match.
void moveFreely(Bodies& bodies, std::span<const Load> loads, const std::optional<Vec3>& gravity,
                double dt);
void moveFreely(Bodies& bodies, BodyId body, const Load& load, const std::optional<Vec3>& gravity,
                double dt);

// Velocities from the displacements that the solve made, (43) and the quaternion logarithm for
// (45).
void finishVelocities(Bodies& bodies, double dt);
void finishVelocity(Bodies& bodies, BodyId body, double dt);

// The turn of this substep, with as many whole turns as `free`: the logarithm alone would take a
// spin beyond pi/h for one the other way round.
Vec3 unwrapped(const Vec3& turn, const Vec3& free);

bool isIsotropic(const Vec3& inertia);

// R I^-1 R^T at the present poses.
void refreshInertia(Bodies& bodies);

// The inverse of M~ (36),(65) in its place, for bodies that turn by no more than 0.2 rad a substep.
void refreshSpinInertia(Bodies& bodies, double dt);

// Takes all motion from dynamic bodies.
void bringToRest(Bodies& bodies);

}  // namespace physics
