// Rows against differences of c, for every kind in the table.
#include <cmath>

#include "tests/physics/kind_cases.h"
#include "tests/physics/trial.h"

namespace physics::testing {
namespace {

template <class Item>
double deviationOf(const Item& item, const Bodies& bodies) {
  return deviation([&](const Bodies& at) { return plainRowOf(item, at); }, bodies);
}

class Gradient : public EveryKindTest {};

TEST_P(Gradient, IsTheDerivativeOfTheError) {
  Random random(1);
  for (int n = 0; n < 300; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    trial->toGradient(random, bodies);
    ASSERT_LT(deviation([&](const Bodies& at) { return trial->rowAt(at); }, bodies), 1e-7)
        << "configuration " << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Gradient, ::testing::ValuesIn(kindsOfTrials()), wordOf);

// A drive's rows are -1 and +1; c is a rotation vector, whose derivative is 1 - [theta]x/2 + ...
// So they are the gradient on the target and leave it at first order, by half the error.
TEST(DriveGradient, IsOffByHalfTheErrorToFirstOrder) {
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    Bodies bodies = randomPair(random);
    Drive item = Case<Drive>::make(random, bodies);
    item.damping = 0;
    Case<Drive>::toGradient(item, random, bodies);
    const double theta = 0.01;
    bodies.pose[1].q = exponential(theta * random.inBall(1).normalized()) * bodies.pose[1].q;
    EXPECT_LT(deviationOf(item, bodies), 0.51 * theta);
  }
}

// A motor reads turns about its axis; a turn across it bends the rows at first order.
TEST(MotorGradient, IsOffByTheTurnAcrossItsAxisToFirstOrder) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    Bodies bodies = randomPair(random);
    const Motor item = Case<Motor>::make(random, bodies);
    bodies.pose = bodies.start;
    const Vec3 across = anyNormalTo(bodies.pose[0].q * item.axisI);
    bodies.pose[1].q = exponential(0.01 * across) * bodies.pose[1].q;
    EXPECT_LT(deviationOf(item, bodies), 1.01 * 0.01 * std::sqrt(3));  // largest entry >= 1/sqrt 3
  }
}

// c of the scalar form is phi, and (81) with its signs turned gives -w, +w.
TEST(AxleGradient, AlongItsErrorIsTheAxisBetween) {
  Random random(4);
  for (int n = 0; n < 100; ++n) {
    Bodies bodies = randomPair(random);
    const Axle item = Case<Axle>::make(random, bodies);
    const auto row = rowOf(item, bodies);
    const Vec3 ni = bodies.pose[0].q * item.axisI, nj = bodies.pose[1].q * item.frameJ.col(2);
    const Vec3 along = row.angular[0].transpose() * row.c.normalized();
    EXPECT_LT((along + ni.cross(nj).normalized()).norm(), 1e-9);
    EXPECT_NEAR(row.c.norm(), angleOf(ni, nj), 1e-14);
  }
}

template <class Item>
bool isFinite(const Item& item, Bodies bodies) {
  const auto row = rowOf(item, bodies);
  bool finite = row.c.allFinite();
  for (const auto& block : row.linear) finite = finite && block.allFinite();
  for (const auto& block : row.angular) finite = finite && block.allFinite();
  Multipliers<Item> lambda;
  finite = finite && visit(item, lambda, bodies) && lambda.total.allFinite();
  for (const Pose& pose : bodies.pose) {
    finite = finite && pose.x.allFinite() && pose.q.coeffs().allFinite();
  }
  return finite;
}

TEST(DegenerateGradient, IsFiniteForParallelAndAntiparallelAxesAndBesideThem) {
  for (const double away : {0.0, 1e-300, 1e-160, 1e-15, 1e-9, 1e-7, 1.1e-7, 1e-4}) {
    for (const double side : {0.0, kPi}) {
      Bodies bodies = bodiesOf({{}, {}});
      bodies.pose[1].q = exponential(Vec3(0, 0, side + away));
      EXPECT_TRUE(
          isFinite(Axle{{0, 1}, Vec3::UnitX(), about({0, 1, 0}, kPi / 2).matrix()}, bodies));
      EXPECT_TRUE(isFinite(ConeLimit{{0, 1}, {Vec3::UnitX(), Vec3::UnitX()}, 0}, bodies));
      EXPECT_TRUE(isFinite(Drive{{0, 1}}, bodies));
    }
  }
}

TEST(DegenerateGradient, IsFiniteForCoincidentPointsAndBesideThem) {
  for (const double away : {0.0, 1e-300, 1e-160, 1e-15, 1e-12, 1.1e-12, 1e-7}) {
    Bodies bodies = bodiesOf({{}, {}});
    bodies.pose[1].x.x() = away;
    EXPECT_TRUE(isFinite(Distance{{0, 1}}, bodies));
    EXPECT_TRUE(isFinite(Spring{{0, 1}}, bodies));
    EXPECT_TRUE(isFinite(BallSocket{{0, 1}}, bodies));
    EXPECT_TRUE(
        isFinite(BallSocket{{0, 1}, {Vec3(0, 0, 0), Vec3(0, 0, 0)}, Form::kScalar}, bodies));
  }
}

TEST(DegenerateGradient, IsFiniteForATwistAtASwingOfAHalfTurn) {
  for (const double away : {0.0, 1e-15, 1e-7, 1e-6, 1e-3}) {
    Bodies bodies = bodiesOf({{}, {}});
    bodies.pose[1].q = exponential(Vec3(0, kPi - away, 0));
    EXPECT_TRUE(isFinite(TwistLimit{{0, 1}, Vec3::UnitX(), Quat::Identity(), 0.1, 0.2}, bodies));
  }
}

TEST(DegenerateGradient, PartsCoincidentPointsOfADistance) {
  Bodies bodies = bodiesOf({{}, {}});
  iterate(Distance{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 0.5}, bodies, 3);
  EXPECT_NEAR((bodies.pose[0].x - bodies.pose[1].x).norm(), 0.5, 1e-12);
}

TEST(DegenerateGradient, ClosesAnAntiparallelAxle) {
  Bodies bodies = bodiesOf({{}, {}});
  bodies.pose[1].q = exponential(Vec3(0, 0, kPi));
  const Axle item{{0, 1}, Vec3::UnitX(), about({0, 1, 0}, kPi / 2).toRotationMatrix()};
  iterate(item, bodies, 5);
  EXPECT_LT(angleOf(bodies.pose[0].q * item.axisI, bodies.pose[1].q * item.frameJ.col(2)), 1e-10);
}

}  // namespace
}  // namespace physics::testing
