// One-sided constraints: cone, twist, rope; and the distance that holds both ways.
#include <gtest/gtest.h>

#include "physics/constraints/cone_limit.h"
#include "physics/constraints/distance.h"
#include "physics/constraints/twist_limit.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

const ConeLimit kCone{{0, 1}, {Vec3::UnitX(), Vec3::UnitX()}, 30 * kDegree};

// Tilted, anisotropic bodies whose x axes are `apart` from each other.
Bodies tilted(double apart) {
  const Quat tilt = about({1, -2, 0.5}, 0.8), spin = about({1, 0, 0}, 1.9);
  return bodiesOf(
      {{1, Vec3(0.3, 0.4, 0.5), {Vec3::Zero(), tilt}},
       {2, Vec3(0.9, 0.7, 0.3), {Vec3::Zero(), tilt * about({0, 1, 1}, apart) * spin}}});
}

double coneAngle(const Bodies& bodies) {
  return angleOf(bodies.pose[0].q * Vec3::UnitX(), bodies.pose[1].q * Vec3::UnitX());
}

TEST(ConeLimit, EndsAtThirtyDegreesWhenEnteredFromFifty) {
  Bodies bodies = tilted(50 * kDegree);
  iterate(kCone, bodies, 10);
  EXPECT_NEAR(coneAngle(bodies) / kDegree, 30, 5e-5);
}

TEST(ConeLimit, EndsAtThirtyDegreesWhenEnteredFromHundredAndForty) {
  Bodies bodies = tilted(140 * kDegree);
  iterate(kCone, bodies, 10);
  EXPECT_NEAR(coneAngle(bodies) / kDegree, 30, 5e-5);
}

TEST(ConeLimit, PushesByExactlyNothingFromTwentyDegrees) {
  Bodies bodies = tilted(20 * kDegree);
  const Bodies before = bodies;
  const auto lambda = iterate(kCone, bodies, 10);
  EXPECT_EQ(lambda.total[0], 0);
  EXPECT_EQ(bodies.pose[0].q.coeffs(), before.pose[0].q.coeffs());
  EXPECT_EQ(bodies.pose[1].q.coeffs(), before.pose[1].q.coeffs());
}

TEST(ConeLimit, TakesItsImpulseBackWhenTheBodiesReturnByThemselves) {
  Bodies bodies = tilted(50 * kDegree);
  Multipliers<ConeLimit> lambda;
  visit(kCone, lambda, bodies);
  EXPECT_LT(lambda.total[0], -0.01);
  bodies = tilted(-20 * kDegree);  // something else brought them back
  for (int k = 0; k < 10; ++k) visit(kCone, lambda, bodies);
  EXPECT_NEAR(coneAngle(bodies), 30 * kDegree, 1e-9);
  EXPECT_LE(lambda.total[0], 0);
}

const TwistLimit kTwist{{0, 1}, Vec3::UnitX(), Quat::Identity(), -40 * kDegree, 60 * kDegree};

double twistAfter(double degrees, int visits) {
  Bodies bodies = tilted(0);
  const Quat swing = about({0, 1, 0}, 0.5);
  bodies.pose[1].q = bodies.pose[0].q * swing * about({1, 0, 0}, degrees * kDegree);
  iterate(kTwist, bodies, visits);
  return kTwist.twist({bodies.pose, bodies.start, 1}) / kDegree;
}

TEST(TwistLimit, ReadsTheTurnAboutTheAxisWhateverTheSwing) {
  for (const double degrees : {-179.0, -90.0, -1e-3, 0.0, 30.0, 120.0, 179.0}) {
    EXPECT_NEAR(twistAfter(degrees, 0), degrees, 1e-12);
  }
}

TEST(TwistLimit, EndsAtItsUpperLimitFromAbove) {
  EXPECT_NEAR(twistAfter(75, 20), 60, 1e-8);
  EXPECT_NEAR(twistAfter(150, 20), 60, 1e-8);
}

TEST(TwistLimit, EndsAtItsLowerLimitFromBelow) {
  EXPECT_NEAR(twistAfter(-50, 20), -40, 1e-8);
  EXPECT_NEAR(twistAfter(-150, 20), -40, 1e-8);
}

TEST(TwistLimit, DoesNothingWithin) {
  for (const double degrees : {-39.0, 0.0, 12.0, 59.0}) {
    EXPECT_EQ(twistAfter(degrees, 10), twistAfter(degrees, 0));
  }
}

// Points 3 kg and 1 kg, `apart` from each other on x.
double distanceAfter(const Distance& item, double apart) {
  Bodies bodies = bodiesOf({{3, Vec3::Zero(), {}}, {1, Vec3::Zero(), at(Vec3(apart, 0, 0))}});
  iterate(item, bodies, 1);
  EXPECT_NEAR(3 * bodies.pose[0].x.x() + bodies.pose[1].x.x(), apart, 1e-15);
  return bodies.pose[1].x.x() - bodies.pose[0].x.x();
}

TEST(Distance, HoldsItsLengthFromBothSides) {
  const Distance rod{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 1};
  EXPECT_NEAR(distanceAfter(rod, 1.5), 1, 1e-15);
  EXPECT_NEAR(distanceAfter(rod, 0.5), 1, 1e-15);
}

TEST(Distance, AsARopePullsAndNeverPushes) {
  const Distance rope{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 1, true};
  EXPECT_NEAR(distanceAfter(rope, 1.5), 1, 1e-15);
  EXPECT_EQ(distanceAfter(rope, 0.5), 0.5);
}

TEST(Distance, BetweenBodiesConvergesWithItsAnchors) {
  Bodies bodies = tilted(1);
  bodies.pose[1].x = Vec3(2, 1, 0);
  const Distance rod{{0, 1}, {Vec3(0.3, 0.2, 0), Vec3(-0.4, 0, 0.1)}, 0.7};
  iterate(rod, bodies, 20);
  EXPECT_LT(std::abs(rowOf(rod, bodies).c[0]), 1e-12);
}

}  // namespace
}  // namespace physics::testing
