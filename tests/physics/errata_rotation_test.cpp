// Misprints of the paper's sections 2, 3 and 4: the printed form beside ours on the smallest
// example.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "physics/constraints/ball_socket.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

// Geometric algebra by Pauli's matrices: vectors are v . sigma, its i is the imaginary unit.
using Spinor = Eigen::Matrix2cd;
constexpr std::complex<double> kI(0, 1);

Spinor inPauli(const Vec3& v) {
  Spinor m;
  m << v.z(), v.x() - kI * v.y(), v.x() + kI * v.y(), -v.z();
  return m;
}

// q r q~ with q = exp(sign i theta/2), (1),(4) to the letter.
Vec3 turnedByLetter(const Vec3& theta, const Vec3& r, double sign) {
  const double half = theta.norm() / 2;
  const Spinor q = std::cos(half) * Spinor::Identity() +
                   sign * kI * std::sin(half) * inPauli(theta.normalized());
  const Spinor turned = q * inPauli(r) * q.adjoint();
  return {turned(1, 0).real(), turned(1, 0).imag(), turned(0, 0).real()};
}

TEST(Erratum1, ByTheLetterOfGeometricAlgebraTheTurnGoesTheOtherWay) {
  const Vec3 theta(0.3, -0.2, 0.5), r(1, 2, 3);
  EXPECT_LT((turnedByLetter(theta, r, 1) - exponential(-theta) * r).norm(), 1e-14);  // printed
  EXPECT_LT((turnedByLetter(theta, r, -1) - exponential(theta) * r).norm(), 1e-14);  // exp(-i ...)
  const Vec3 rate = (turnedByLetter(1e-6 * theta, r, 1) - r) / 1e-6;                 // (5)
  EXPECT_LT((rate + theta.cross(r)).norm(), 1e-5);
}

Quat sumOf(const Quat& a, const Quat& b) { return Quat(Eigen::Vector4d(a.coeffs() + b.coeffs())); }
Quat pure(const Vec3& v) { return Quat(0, v.x(), v.y(), v.z()); }
Quat times(double factor, const Quat& q) { return Quat(Eigen::Vector4d(factor * q.coeffs())); }

// 1 + 1/2 int w + 1/4 intint w'' w' of (7) for a spin `a` in [0, t/2] and `b` after it. The inner
// integral over t' < t'' is 1/2 (t/2)^2 (a a + b b) + (t/2)^2 b a; `square`: t' and t'' both to t.
double errorOf7(double t, bool square) {
  const Vec3 a(1, 0, 0.5), b(0, 2, 0);
  const double half = t / 2;
  const Quat qa = pure(a), qb = pure(b);
  const Quat linear = times(0.5 * half, sumOf(qa, qb));
  Quat twice = sumOf(times(0.5, sumOf(qa * qa, qb * qb)), qb * qa);
  if (square) twice = sumOf(qa, qb) * sumOf(qa, qb);
  const Quat series = sumOf(sumOf(Quat::Identity(), linear), times(0.25 * half * half, twice));
  Pose pose;  // later on the left
  displace(pose, Vec3::Zero(), half * a);
  displace(pose, Vec3::Zero(), half * b);
  return (series.coeffs() - pose.q.coeffs()).norm();
}

// Printed, the limits are those of no region: t'' to t and t' to t'', or both to t.
TEST(Erratum7, TheInnerIntegralEndsAtTheLaterTime) {
  EXPECT_NEAR(errorOf7(0.02, false) / errorOf7(0.01, false), 8, 0.1);
  EXPECT_NEAR(errorOf7(0.02, true) / errorOf7(0.01, true), 4, 0.1);
  EXPECT_GT(errorOf7(0.01, true), 100 * errorOf7(0.01, false));
}

// M~ of (36),(65) as printed for a rod 1:1:10 turning by .5 rad a step.
TEST(Erratum42, WithTheSpinTheMatrixIsNeitherSymmetricNorPositive) {
  const Vec3 inertia = Vec3(1 + 100, 1 + 100, 2) / 12;
  Bodies bodies = bodiesOf({{1, inertia, {}}});
  const Mat3 plain = inertia.asDiagonal();
  double least = 1, asymmetry = 0;
  Random random(80);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 turn = 0.5 * random.inBall(1).normalized(), d = random.inBall(1).normalized();
    const Mat3 spinning = plain - skew(plain * turn) + plain * skew(turn);
    asymmetry = std::max(asymmetry, (spinning - spinning.transpose()).norm());
    least = std::min(least, d.dot(spinning.inverse() * d));
    bodies.velocity[0].w = 60 * turn;
    refreshSpinInertia(bodies, 1.0 / 60);  // steps aside beyond .2 rad
    EXPECT_GT(d.dot(bodies.inverse[0].inertia * d), 0);
  }
  EXPECT_GT(asymmetry, 1);
  EXPECT_LT(least, 0);
}

// (54) prints J M J^T: two points of 4 kg, a metre apart.
TEST(Erratum54, TheMatrixIsThatOfTheInverseMass) {
  Bodies bodies = bodiesOf({{4, Vec3::Zero(), {}}, {4, Vec3::Zero(), at(Vec3(1, 0, 0))}});
  const double printed = (4.0 + 4.0), ours = 0.25 + 0.25;
  EXPECT_GT(1 - ours * (1 / printed), 0.9);  // nearly all of the gap is left
  iterate(BallSocket{{0, 1}}, bodies, 1);
  EXPECT_LT((bodies.pose[0].x - bodies.pose[1].x).norm(), 1e-15);
}

}  // namespace
}  // namespace physics::testing
