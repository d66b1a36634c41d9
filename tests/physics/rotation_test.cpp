// Our own sine, arc tangent, exponential and logarithm against the C library's in long double.
#include "physics/base/rotation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

double sineError(double angle) {
  const SineCosine ours = sineCosine(angle);
  const long double s = std::sin(static_cast<long double>(angle)),
                    c = std::cos(static_cast<long double>(angle));
  return static_cast<double>(std::max(std::abs(ours.sine - s), std::abs(ours.cosine - c)));
}

double worstSine(double range) {
  Random random(20);
  double worst = 0;
  for (int n = 0; n < 200000; ++n) {
    worst = std::max(worst, sineError(random.uniform(-range, range)));
  }
  return worst;
}

// 2e-16 is what physics/base/rotation.h promises; rounding of a result in [1/2, 1] alone is
// 0.6e-16.
TEST(SineCosine, IsExactToRoundingWithinATurn) { EXPECT_LT(worstSine(2 * kPi), 2e-16); }

TEST(SineCosine, IsExactToRoundingForManyTurns) { EXPECT_LT(worstSine(100), 2e-16); }

TEST(SineCosine, IsExactToRoundingUpToAMillion) { EXPECT_LT(worstSine(1e6), 2e-16); }

TEST(SineCosine, StaysOnTheUnitCircleHoweverLargeTheAngle) {
  for (double angle = 1; angle < 1e308; angle *= 7) {
    const auto [sine, cosine] = sineCosine(-angle);
    EXPECT_NEAR(sine * sine + cosine * cosine, 1, 1e-14) << angle;
  }
  EXPECT_TRUE(std::isnan(sineCosine(std::numeric_limits<double>::infinity()).sine));
}

TEST(SineCosine, IsExactAtZero) {
  EXPECT_EQ(sineCosine(0).sine, 0);
  EXPECT_EQ(sineCosine(0).cosine, 1);
}

// Half a unit in the last place of pi is 2.2e-16; two square roots and two differences, measured
// 7e-16.
TEST(ArcTangent, IsExactToThreeRoundingsEverywhere) {
  Random random(21);
  double worst = 0;
  for (int n = 0; n < 200000; ++n) {
    const double y = random.uniform(-1, 1), x = random.uniform(-1, 1);
    const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    worst = std::max(worst, static_cast<double>(std::abs(arcTangent(y, x) - exact)));
  }
  EXPECT_LT(worst, 1e-15);
}

TEST(ArcTangent, KeepsItsDigitsForSmallAngles) {
  for (double t = 1e-300; t < 1; t *= 3.7) EXPECT_NEAR(arcTangent(t, 1) / std::atan(t), 1, 5e-16);
}

TEST(ArcTangent, KnowsTheAxes) {
  EXPECT_EQ(arcTangent(0, 0), 0);
  EXPECT_EQ(arcTangent(0, 1), 0);
  EXPECT_EQ(arcTangent(1, 0), kPi / 2);
  EXPECT_EQ(arcTangent(-1, 0), -kPi / 2);
  EXPECT_EQ(arcTangent(0, -1), kPi);
}

TEST(Exponential, IsTheQuaternionOfAngleAndAxis) {
  Random random(22);
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-3, 0.0999, 0.1001, 1.0, 3.0, kPi, 5.0, 17.0}) {
    const Vec3 axis = random.inBall(1).normalized();
    const Quat exact(Eigen::AngleAxisd(angle, axis));
    EXPECT_LT((exponential(angle * axis).coeffs() - exact.coeffs()).norm(), 2e-15) << angle;
  }
}

TEST(Exponential, IsAUnitQuaternion) {
  Random random(23);
  for (int n = 0; n < 10000; ++n) {
    EXPECT_NEAR(exponential(random.inBall(7)).norm(), 1, 4e-16);
  }
}

TEST(Logarithm, UndoesTheExponential) {
  Random random(24);
  for (const double angle : {0.0, 1e-300, 1e-150, 1e-12, 1e-6, 0.0999, 0.1, 0.1001, 1.0, 2.0, 3.0,
                             kPi - 1e-6, kPi - 1e-12}) {
    const Vec3 theta = angle * random.inBall(1).normalized();
    EXPECT_LT((logarithm(exponential(theta)) - theta).norm(), 2e-15 * (1e-100 + angle)) << angle;
  }
}

TEST(Logarithm, TakesTheShorterWay) {
  const Vec3 axis = Vec3(1, 2, -2) / 3;
  EXPECT_LT((logarithm(exponential(5 * axis)) - (5 - 2 * kPi) * axis).norm(), 1e-14);
  EXPECT_LT((logarithm(exponential((kPi + 1e-9) * axis)) + (kPi - 1e-9) * axis).norm(), 1e-14);
}

TEST(Logarithm, OfAHalfTurnIsPi) {
  const Vec3 axis = Vec3(1, 2, -2) / 3;
  EXPECT_NEAR(logarithm(Quat(0, axis.x(), axis.y(), axis.z())).norm(), kPi, 1e-15);
}

TEST(Logarithm, IsTheSameForBothSigns) {
  Random random(25);
  for (int n = 0; n < 1000; ++n) {
    const Quat q = random.rotation(kPi);
    EXPECT_EQ(logarithm(q), logarithm(Quat(-q.coeffs())));
  }
}

TEST(AnyNormal, IsAUnitNormal) {
  Random random(26);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 axis = n < 3 ? Vec3(Vec3::Unit(n)) : random.inBall(1).normalized();
    EXPECT_NEAR(anyNormalTo(axis).norm(), 1, 4e-16);
    EXPECT_NEAR(anyNormalTo(axis).dot(axis), 0, 4e-16);
  }
}

TEST(AngleBetween, TurnsTheFirstOntoTheSecond) {
  Random random(27);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 a = random.inBall(1).normalized(), b = random.inBall(1).normalized();
    const AngleBetween between = angleBetween(a, b);
    EXPECT_LT((exponential(between.phi * between.w) * a - b).norm(), 3e-15);
  }
}

TEST(AngleBetween, OfParallelAndAntiparallelHasANormal) {
  const Vec3 a = Vec3(2, -1, 2) / 3;
  EXPECT_EQ(angleBetween(a, a).phi, 0);
  EXPECT_EQ(angleBetween(a, -a).phi, kPi);
  EXPECT_NEAR(angleBetween(a, -a).w.dot(a), 0, 1e-15);
}

}  // namespace
}  // namespace physics::testing
