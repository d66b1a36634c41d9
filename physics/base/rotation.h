// Rotations: exponential and logarithm of quaternions, and the few transcendental functions that
// reach the state. They are our own so that every x86-64 gives the same bits (the C library picks
// variants by CPU).
#pragma once

#include "physics/base/types.h"

namespace physics {

struct SineCosine {
  double sine, cosine;
};
SineCosine sineCosine(double angle);    // |angle| < 1e6, error < 2e-16
double arcTangent(double y, double x);  // atan2, in (-pi, pi], error < 1e-15

constexpr double kPi = 3.14159265358979323846;

// q = (cos |theta|/2, theta/|theta| sin |theta|/2)                                              (1)
Quat exponential(const Vec3& theta);

// theta of a unit quaternion by the shortest arc, |theta| <= pi; the inverse of (1). NOTES 3.3
Vec3 logarithm(const Quat& q);

inline Mat3 skew(const Vec3& v) {  // [v]x of (18)
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// X -> X + dX: x += dx, q <- exp(dtheta) q                                                (44),(46)
inline void displace(Pose& pose, const Vec3& dx, const Vec3& dtheta) {
  pose.x += dx;
  pose.q = exponential(dtheta) * pose.q;
}

// A unit quaternion that rounding has left: right to the square of what it is off by, without a
// root.
inline void renormalize(Quat& q) { q.coeffs() *= 1.5 - 0.5 * q.squaredNorm(); }

// The shortest turn that takes the direction of `from` to that of `to`.
Quat turnBetween(const Vec3& from, const Vec3& to);

// A unit vector normal to the unit vector n, the same for the same n.
Vec3 anyNormalTo(const Vec3& n);

// The angle from n_i to n_j and the axis it turns about: phi w = directed angle error.   (80),(82)
// Parallel: phi = 0 and w is normal to n_i; antiparallel: phi = pi, any w normal to n_i.
struct AngleBetween {
  double phi = 0;          // rad, 0..pi
  Vec3 w = Vec3::UnitX();  // unit
};
AngleBetween angleBetween(const Vec3& ni, const Vec3& nj);

// The rotation that takes y to `direction`, by the shortest way.
Quat fromUp(const Vec3& direction);

}  // namespace physics
