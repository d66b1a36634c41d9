// Ball and socket, (60)-(73), in both forms.
#include "physics/constraints/ball_socket.h"

#include <gtest/gtest.h>

#include "physics/constraints/pull_stiffness.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

// Two rods whose ends should meet, well apart and askew.
Bodies openJoint() {
  BodyOf i{1, Vec3(0.0852, 0.0208, 0.0852), {Vec3(-0.6, 0.3, 0), about({1, 2, 3}, 0.7)}};
  BodyOf j{2, Vec3(0.17, 0.04, 0.2), {Vec3(0.7, -0.2, 0.3), about({-2, 1, 1}, 1.1)}};
  return bodiesOf({i, j});
}

BallSocket joint(Form form) { return {{0, 1}, {Vec3(0.1, 0.5, 0), Vec3(0, -0.5, 0.1)}, form}; }

Vec3 gap(const BallSocket& item, const Bodies& bodies) { return rowOf(item, bodies).c; }

TEST(BallSocket, ClosesTheGapInOneIterationForPoints) {
  for (const Form form : {Form::kVector, Form::kScalar}) {
    BodyOf heavy{3, Vec3::Zero(), at(Vec3(1, 2, 3))}, light{1, Vec3::Zero(), {}};
    Bodies bodies = bodiesOf({heavy, light});
    iterate(BallSocket{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, form}, bodies, 1);
    EXPECT_LT((bodies.pose[0].x - bodies.pose[1].x).norm(), 1e-15);
    EXPECT_LT((bodies.pose[0].x - Vec3(0.75, 1.5, 2.25)).norm(), 1e-15);  // the centre of mass
  }
}

TEST(BallSocket, ScalarErrorFallsWithEveryIteration) {
  Bodies bodies = openJoint();
  const BallSocket item = joint(Form::kScalar);
  double last = gap(item, bodies).norm();
  for (int k = 0; k < 8; ++k) {
    iterate(item, bodies, 1);
    const double now = gap(item, bodies).norm();
    EXPECT_LT(now, 0.5 * last) << "iteration " << k;  // NOTES figure 2: .840 .159 .031 .005 .001
    last = now;
  }
}

TEST(BallSocket, VectorFormConvergesQuadratically) {
  Bodies bodies = openJoint();
  iterate(joint(Form::kVector), bodies, 6);
  EXPECT_LT(gap(joint(Form::kVector), bodies).norm(), 1e-14);  // NOTES 3.4: 1e-14 in 4
}

TEST(BallSocket, ScalarImpulseIsParallelToTheGap) {
  Bodies bodies = openJoint();
  const BallSocket item = joint(Form::kScalar);
  for (int k = 0; k < 5; ++k) {
    const Vec3 dp = gap(item, bodies);
    Multipliers<BallSocket> lambda;
    visit(item, lambda, bodies);
    EXPECT_LT(dp.normalized().cross(lambda.total).norm(), 1e-14 * lambda.total.norm());
    EXPECT_LT(dp.dot(lambda.total), 0);
  }
}

TEST(BallSocket, ScalarFormTurnsThePairByNothing) {
  Bodies bodies = openJoint();
  const Bodies before = bodies;
  Multipliers<BallSocket> lambda;
  visit(joint(Form::kScalar), lambda, bodies);
  const Momenta sum = given(before, bodies);
  EXPECT_LT(sum.angular.norm(), 1e-13 * sum.angularScale);
}

TEST(BallSocket, VectorFormTurnsThePairByTheGapTimesTheImpulse) {
  Bodies bodies = openJoint();
  const Bodies before = bodies;
  const BallSocket item = joint(Form::kVector);
  const Vec3 dp = gap(item, bodies);
  Multipliers<BallSocket> lambda;
  visit(item, lambda, bodies);
  const Momenta sum = given(before, bodies);
  EXPECT_LT((sum.angular - dp.cross(lambda.total)).norm(), 1e-13 * sum.angularScale);
  EXPECT_GT(sum.angular.norm(), 1e-3 * sum.angularScale);  // NOTES 3.4: the price of this form
}

TEST(BallSocket, MultiplierIsTheImpulseOnTheFirstBody) {
  Bodies bodies = openJoint();
  const Bodies before = bodies;
  Multipliers<BallSocket> lambda;
  visit(joint(Form::kVector), lambda, bodies);
  EXPECT_LT((bodies.pose[0].x - before.pose[0].x - lambda.total).norm(), 1e-14);      // 1 kg
  EXPECT_LT((bodies.pose[1].x - before.pose[1].x + lambda.total / 2).norm(), 1e-14);  // 2 kg
}

TEST(BallSocket, SolvesFromTheWorldBody) {
  Bodies bodies = bodiesOf({BodyOf{0, Vec3::Zero(), {}}, BodyOf{}});
  bodies.pose[1].x = Vec3(0.2, 0, 0);
  const BallSocket item{{0, 1}, {Vec3(0, 1, 0), Vec3(0, 1, 0)}};
  iterate(item, bodies, 5);
  EXPECT_LT(gap(item, bodies).norm(), 1e-14);
}

// What the torque of a force changes by when the arm turns.
Vec3 torqueChange(const Vec3& force, const Vec3& arm, const Vec3& theta) {
  return theta.cross(arm).cross(force);
}

TEST(PullStiffness, TurnsBackAcrossTheForce) {
  Random random(31);
  for (int n = 0; n < 100; ++n) {
    const Vec3 force = random.inBall(10), arm = random.inBall(1);
    const Mat3 stiffness = pullStiffness(force, arm);
    if (force.dot(arm) < 0) {
      EXPECT_TRUE(stiffness.isZero(0));
      continue;
    }
    const Vec3 across = force.cross(random.inBall(1));
    EXPECT_LT((stiffness * across + torqueChange(force, arm, across)).norm(),
              1e-13 * stiffness.norm() * across.norm() + 1e-14);
    EXPECT_LT((stiffness * force).norm(), 1e-14 * stiffness.norm() * force.norm());
  }
}

TEST(PullStiffness, OfTwoAnchorsBesideEachOtherIsAllThereIs) {
  const Vec3 force(7, 0, 0);
  for (const Vec3& theta : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.3, -2, 1)}) {
    Vec3 change = Vec3::Zero();
    for (const double side : {-0.3, 0.3}) {
      const Vec3 arm(0.1, 0, side);
      change += pullStiffness(force, arm) * theta + torqueChange(force, arm, theta);
    }
    EXPECT_LT(change.norm(), 1e-14);
  }
}

}  // namespace
}  // namespace physics::testing
