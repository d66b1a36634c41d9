// Misprints of the paper's solver, sections 4 and 5: the printed form beside ours on the smallest
// example.
#include <gtest/gtest.h>

#include "physics/constraints/ball_socket.h"
#include "physics/constraints/distance.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

// One point at .3, told to be at 0 and at 1, with alpha = .5; 200 sweeps.
struct Conflict {
  double x = 0.3, first = 0, second = 0;
};

Conflict printed59() {
  Conflict now;
  const double mu = 1 / (1 + 0.5);
  for (int k = 0; k < 200; ++k) {
    for (double* lambda : {&now.first, &now.second}) {
      const double c = now.x - (lambda == &now.second ? 1 : 0);
      const double change = -mu * (c - 0.5 * *lambda);
      *lambda += change;
      now.x += change;
    }
  }
  return now;
}

Conflict ours59() {
  Bodies bodies = bodiesOf({{0, Vec3::Zero(), {}}, {1, Vec3::Zero(), at(Vec3(0.3, 0, 0))}});
  const BallSocket first{{1, 0}, {Vec3::Zero(), Vec3::Zero()}};
  const BallSocket second{{1, 0}, {Vec3::Zero(), Vec3(1, 0, 0)}};
  Multipliers<BallSocket> lambda1, lambda2;
  for (int k = 0; k < 200; ++k) {
    Scratch<BallSocket> scratch;
    solve(first, lambda1, {1, 0.5}, bodies, 1, scratch);
    solve(second, lambda2, {1, 0.5}, bodies, 1, scratch);
  }
  return {bodies.pose[1].x.x(), lambda1.total.x(), lambda2.total.x()};
}

TEST(Erratum59, AlphaTimesLambdaIsAddedNotTakenAway) {
  EXPECT_GT(std::abs(printed59().first), 1e30);
  // (A + alpha) lambda = -c with A = all ones: lambda1 + lambda2 = (1 - .6)/2.5, their
  // difference 2.
  EXPECT_NEAR(ours59().first, -0.92, 1e-12);
  EXPECT_NEAR(ours59().second, 1.08, 1e-12);
  EXPECT_NEAR(ours59().x, 0.46, 1e-12);
}

// A rod between two bodies, lengths given in metres or, with unit = 1000, in millimetres.
Bodies levers(double unit) {
  const Vec3 inertia = Vec3(0.02, 0.03, 0.04) * unit * unit;
  return bodiesOf({{1, inertia, {}}, {2, inertia, at(Vec3(1, 0.2, 0) * unit)}});
}
Distance rod(double unit) {
  return {{0, 1}, {Vec3(0.1, 0.3, 0) * unit, Vec3(0, -0.2, 0.1) * unit}, 0.5 * unit};
}

double printedMu58(double unit) {
  const Bodies bodies = levers(unit);
  const auto row = rowOf(rod(unit), bodies);
  double sum = 0;
  for (int b = 0; b < 2; ++b) {
    const Mat3 inertia = bodies.inverse[b].inertia + 0.5 * Mat3::Identity();
    sum += (bodies.inverse[b].m + 0.5) * row.linear[b].squaredNorm();
    sum += (row.angular[b] * inertia * row.angular[b].transpose())(0, 0);
  }
  return 1 / sum;
}

double ourMu58(double unit) {
  Bodies bodies = levers(unit);
  const double c = rowOf(rod(unit), bodies).c[0];
  Multipliers<Distance> lambda;
  Scratch<Distance> scratch;
  solve(rod(unit), lambda, {1, 0.5}, bodies, 1, scratch);
  return -lambda.total[0] / c;
}

TEST(Erratum58, AlphaStandsOutsideTheSumSoThatUnitsOfLengthDoNotMatter) {
  EXPECT_GT(printedMu58(1), 1000 * printedMu58(1000));
  EXPECT_NEAR(ourMu58(1), ourMu58(1000), 1e-14);
}

Bodies openPair() {
  return bodiesOf({{1, Vec3(0.0852, 0.0208, 0.0852), {Vec3(-0.6, 0.3, 0), about({1, 2, 3}, 0.7)}},
                   {2, Vec3(0.17, 0.04, 0.2), {Vec3(0.7, -0.2, 0.3), about({-2, 1, 1}, 1.1)}}});
}
const BallSocket kJoint{{0, 1}, {Vec3(0.1, 0.5, 0), Vec3(0, -0.5, 0.1)}, Form::kScalar};

double gap(const Bodies& bodies) { return rowOf(kJoint, bodies).c.norm(); }

// c = |dp| with J and mu of the start, as in Algorithm 1.
Bodies printed66(Bodies bodies, int iterations) {
  const auto row = rowOf(kJoint, bodies);
  const Vec3 d = row.c.normalized();
  Response<BallSocket> response;
  const double mu = 1 / d.dot(effectiveMassInverse(kJoint, row, bodies.inverse, response) * d);
  for (int k = 0; k < iterations; ++k) {
    const Vec3 change = -mu * gap(bodies) * d;
    for (int b = 0; b < 2; ++b) {
      displace(bodies.pose[b], response.linear[b] * change, response.angular[b] * change);
    }
  }
  return bodies;
}

TEST(Erratum66, AFrozenDirectionRatchets) {
  const Bodies start = openPair();
  EXPECT_GT(gap(printed66(start, 10)), gap(printed66(start, 5)));
  EXPECT_GT(gap(printed66(start, 40)), 1e4 * gap(start));
  Bodies ours = start;
  iterate(kJoint, ours, 40);
  EXPECT_LT(gap(ours), 1e-12);
}

// Singular value of the regularised inverse, by our step.
double regularised(double sigma, double alpha) {
  using One = Eigen::Matrix<double, 1, 1>;
  return -sigma * step<1>(One(sigma * sigma), alpha, 1, Form::kVector, One(1))[0];
}

TEST(ErratumAfter54, TheLimitIsZeroAndTheLargestValueOneOverTwiceTheRootOfAlpha) {
  constexpr double kAlpha = 0.01;
  EXPECT_LT(regularised(1e-6, kAlpha), 1.01e-4);  // printed: goes to 1/alpha = 100
  EXPECT_NEAR(regularised(std::sqrt(kAlpha), kAlpha), 5, 1e-12);
  for (double sigma = 1e-6; sigma < 10; sigma *= 1.1) EXPECT_LE(regularised(sigma, kAlpha), 5);
  EXPECT_NEAR(regularised(10, kAlpha), 0.1, 1e-4);  // sigma^2 >> alpha: the inverse
}

// M dp is parallel to dp only where, besides I ~ 1, each lever is along dp or across it.
TEST(Erratum73, ScalarInertiaAloneDoesNotMakeTheVectorFormParallelToTheGap) {
  Random random(30);
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    Bodies bodies = bodiesOf({{1, Vec3::Constant(0.1), {}}, {1, Vec3::Constant(0.1), {}}});
    const BallSocket joint{{0, 1}, {random.inBall(0.5), random.inBall(0.5)}};
    const Vec3 dp = rowOf(joint, bodies).c;
    Multipliers<BallSocket> vector, scalar;
    visit(joint, vector, bodies);
    worst = std::max(worst, angleOf(-vector.total, dp));
    bodies.pose = bodies.start;
    BallSocket along = joint;
    along.form = Form::kScalar;
    visit(along, scalar, bodies);
    EXPECT_LT(angleOf(-scalar.total, dp), 1e-14);
  }
  EXPECT_GT(worst, 5 * kDegree);
}

// A turn made in two corrections of 2.5 rad; h = 1/60.
TEST(Erratum45, SummedIncrementsSpinFasterThanAnyTurnOfTheStep) {
  const double h = 1.0 / 60;
  Bodies bodies = bodiesOf({{1, Vec3::Constant(0.1), {}}});
  Vec3 summed = Vec3::Zero();
  for (const Vec3& turn : {Vec3(2.5, 0, 0), Vec3(2.5, 0.1, 0), Vec3(2.4, 0, 0.1)}) {
    displace(bodies.pose[0], Vec3::Zero(), turn);
    summed += turn;
  }
  finishVelocities(bodies, h);
  EXPECT_GT((summed / h).norm(), 2.3 * kPi / h);
  EXPECT_LE(bodies.velocity[0].w.norm(), kPi / h);
  const Quat reached = exponential(h * bodies.velocity[0].w) * bodies.start[0].q;
  EXPECT_LT(reached.angularDistance(bodies.pose[0].q), 1e-14);
}

}  // namespace
}  // namespace physics::testing
