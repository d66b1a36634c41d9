// Exponential, logarithm and their polynomials.
#include "physics/base/rotation.h"

#include <cmath>

namespace physics {
namespace {

// Taylor sums in Horner form; with |r| <= pi/4 the first term left out is below 1e-19.
double sineReduced(double r) {
  const double t = r * r;
  double sum = -1.0 / 121645100408832000.0;
  sum = sum * t + 1.0 / 355687428096000.0;
  sum = sum * t - 1.0 / 1307674368000.0;
  sum = sum * t + 1.0 / 6227020800.0;
  sum = sum * t - 1.0 / 39916800.0;
  sum = sum * t + 1.0 / 362880.0;
  sum = sum * t - 1.0 / 5040.0;
  sum = sum * t + 1.0 / 120.0;
  sum = sum * t - 1.0 / 6.0;
  return r + r * t * sum;
}

double cosineReduced(double r) {
  const double t = r * r;
  double sum = 1.0 / 2432902008176640000.0;
  sum = sum * t - 1.0 / 6402373705728000.0;
  sum = sum * t + 1.0 / 20922789888000.0;
  sum = sum * t - 1.0 / 87178291200.0;
  sum = sum * t + 1.0 / 479001600.0;
  sum = sum * t - 1.0 / 3628800.0;
  sum = sum * t + 1.0 / 40320.0;
  sum = sum * t - 1.0 / 720.0;
  sum = sum * t + 1.0 / 24.0;
  return 1.0 - 0.5 * t + t * t * sum;
}

// atan for |t| <= tan(pi/16) < 0.2: odd series to t^25.
double arcTangentSmall(double t) {
  const double s = t * t;
  double sum = 0;
  for (int n = 25; n >= 3; n -= 2) sum = s * (((n / 2) % 2 == 1 ? -1.0 : 1.0) / n + sum);
  return t + t * sum;
}

// atan for 0 <= t <= 1, by two halvings: atan t = 2 atan(t / (1 + sqrt(1 + t^2))).
double arcTangentUnit(double t) {
  const double half = t / (1 + std::sqrt(1 + t * t));
  const double quarter = half / (1 + std::sqrt(1 + half * half));
  return 4 * arcTangentSmall(quarter);
}

constexpr double kSmallAngleSquared = 1e-2;  // below: five terms are exact to 1e-17

}  // namespace

SineCosine sineCosine(double angle) {
  // pi/2 in three parts (Cody and Waite): k times each of the first two is exact while |k| < 2^20.
  constexpr double kHalfPi1 = 1.57079632673412561417e+00, kHalfPi2 = 6.07710050630396597660e-11,
                   kHalfPi3 = 2.02226624879595063154e-21;
  // Beyond that the turns are counted in doubles of 2 pi: a bounded angle, if not that one.
  if (!(std::abs(angle) < 1e6)) angle = std::remainder(angle, 2 * kPi);
  const double k = std::nearbyint(angle * (2 / kPi));
  const double r = ((angle - k * kHalfPi1) - k * kHalfPi2) - k * kHalfPi3;
  const double s = sineReduced(r), c = cosineReduced(r);
  const double quadrant = k - 4 * std::floor(k / 4);  // not a number stays none
  if (quadrant == 0) return {s, c};
  if (quadrant == 1) return {c, -s};
  if (quadrant == 2) return {-s, -c};
  return {-c, s};
}

double arcTangent(double y, double x) {
  const double ay = std::abs(y), ax = std::abs(x);
  if (ax == 0 && ay == 0) return 0;
  double angle = ay <= ax ? arcTangentUnit(ay / ax) : kPi / 2 - arcTangentUnit(ax / ay);
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

Quat exponential(const Vec3& theta) {
  const double squared = theta.squaredNorm();
  double cosine, halfSinc;  // cos(|theta|/2), sin(|theta|/2)/|theta|
  if (squared < kSmallAngleSquared) {
    constexpr double k2 = 1 / 2.0, k12 = 1 / 12.0, k30 = 1 / 30.0, k56 = 1 / 56.0, k90 = 1 / 90.0,
                     k6 = 1 / 6.0, k20 = 1 / 20.0, k42 = 1 / 42.0, k72 = 1 / 72.0;
    const double t = 0.25 * squared;
    cosine = 1 - t * k2 * (1 - t * k12 * (1 - t * k30 * (1 - t * k56 * (1 - t * k90))));
    halfSinc = 0.5 * (1 - t * k6 * (1 - t * k20 * (1 - t * k42 * (1 - t * k72))));
  } else {
    const double angle = std::sqrt(squared);
    const SineCosine half = sineCosine(0.5 * angle);
    cosine = half.cosine;
    halfSinc = half.sine / angle;
  }
  return Quat(cosine, halfSinc * theta.x(), halfSinc * theta.y(), halfSinc * theta.z());
}

Vec3 logarithm(const Quat& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const double w = sign * q.w();
  const Vec3 v = sign * q.vec();
  const double squared = v.squaredNorm();
  if (squared <
      0.25 * kSmallAngleSquared) {  // asin series; w = sqrt(1 - |v|^2) for a unit quaternion
    const double factor =
        2 * (1 + squared / 6 *
                     (1 + squared * 9 / 20 *
                              (1 + squared * 25 / 42 *
                                       (1 + squared * 49 / 72 * (1 + squared * 81 / 110)))));
    return factor * v;
  }
  const double sine = std::sqrt(squared);
  return (2 * arcTangent(sine, w) / sine) * v;
}

Vec3 anyNormalTo(const Vec3& n) {
  int smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  return n.cross(Vec3::Unit(smallest)).normalized();
}

// Eigen's own instantiates a singular value decomposition for opposite vectors.
Quat turnBetween(const Vec3& from, const Vec3& to) {
  constexpr double kOpposite = 1e-12;  // of 1 + cosine, 1e4 roundings: less tells of no angle
  const Vec3 a = from.normalized(), b = to.normalized();
  const Vec3 cross = a.cross(b);
  const double cosine = b.dot(a);
  Quat turn;
  if (cosine < -1 + kOpposite) {
    const Vec3 axis = cross.isZero(0) ? anyNormalTo(a) : Vec3(cross.normalized());
    turn.w() = 0.5 * (a + b).norm();
    turn.vec() = std::sqrt(1 - turn.w() * turn.w()) * axis;
  } else {
    const double twice = std::sqrt((1 + cosine) * 2);
    turn.w() = twice * 0.5;
    turn.vec() = cross * (1 / twice);
  }
  return turn;
}

AngleBetween angleBetween(const Vec3& ni, const Vec3& nj) {
  const Vec3 cross = ni.cross(nj);
  const double sine = cross.norm();
  AngleBetween result;
  result.phi = arcTangent(sine, ni.dot(nj));
  result.w = sine > 1e-12 ? Vec3(cross / sine) : anyNormalTo(ni);
  return result;
}

Quat fromUp(const Vec3& direction) {
  const Vec3 d = direction.normalized();
  if (d.y() < -1 + 1e-12) return Quat(0, 1, 0, 0);  // down: any half turn serves
  const Vec3 axis = Vec3::UnitY().cross(d);
  return Quat(1 + d.y(), axis.x(), axis.y(), axis.z()).normalized();
}

}  // namespace physics
