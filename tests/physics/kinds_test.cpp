// What every kind promises: momenta, rest, bodies that do not move, and an end without residual.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstring>

#include "tests/physics/trial.h"

namespace physics::testing {
namespace {

constexpr int kSamples = 200;

bool sameBits(const Pose& a, const Pose& b) {
  return std::memcmp(a.x.data(), b.x.data(), sizeof(double) * 3) == 0 &&
         std::memcmp(a.q.coeffs().data(), b.q.coeffs().data(), sizeof(double) * 4) == 0;
}

double distance(const Pose& a, const Pose& b) {
  return (a.x - b.x).norm() + logarithm(a.q * b.q.conjugate()).norm();
}

void fix(Bodies& bodies, int b) {
  bodies.inverse[b] = {};
  bodies.inverseInertia[b].setZero();
  bodies.motion[b] = Motion::kStatic;
}

class EveryKind : public EveryKindTest {};

TEST_P(EveryKind, MovesSomethingWhenViolated) {
  Random random(10);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    const Bodies before = bodies;
    ASSERT_TRUE(trial->visit(bodies));
    EXPECT_GT(distance(before.pose.back(), bodies.pose.back()), 1e-6);
  }
}

TEST_P(EveryKind, IsFrozenAsItIsEvaluated) {
  Random random(19);
  Bodies bodies = some(random);
  trialOf(random, bodies)->expectFrozen(bodies);
}

TEST_P(EveryKind, KeepsLinearMomentum) {
  if (GetParam().isExternal) GTEST_SKIP() << "a force of the surroundings";
  Random random(11);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    const Bodies before = bodies;
    trial->visit(bodies);
    const Momenta sum = given(before, bodies);
    // Positions of a few metres hold displacements to 1e-15.
    EXPECT_LE(sum.linear.norm(), 1e-13 * std::max(1.0, sum.linearScale));
  }
}

// About the points where the impulses act. In the vector form of a ball the open gap is a lever:
// BallSocket.VectorFormTurnsThePairByTheGapTimesTheImpulse.
TEST_P(EveryKind, KeepsAngularMomentumOfThePair) {
  if (GetParam().isExternal) GTEST_SKIP() << "a force of the surroundings";
  Random random(12);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    trial->makeScalar();
    const Bodies before = bodies;
    trial->visit(bodies);
    for (const Pose& pose : bodies.pose) ASSERT_GT(pose.q.norm(), 0);
    const Momenta sum = given(before, bodies);
    EXPECT_LE(sum.angular.norm(), 1e-12 * std::max(1.0, sum.angularScale)) << n;
  }
}

TEST_P(EveryKind, LeavesAnImmovableBodyAsItIsToTheBit) {
  Random random(13);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    const int fixed = n % bodies.size(), other = (fixed + 1) % bodies.size();
    fix(bodies, fixed);
    const Bodies before = bodies;
    for (int k = 0; k < 3; ++k) trial->visit(bodies);
    EXPECT_TRUE(sameBits(before.pose[fixed], bodies.pose[fixed]));
    if (other != fixed) {
      EXPECT_FALSE(sameBits(before.pose[other], bodies.pose[other]));
    }
  }
}

TEST_P(EveryKind, DoesNothingBetweenImmovableBodies) {
  Random random(14);
  Bodies bodies = some(random);
  const auto trial = trialOf(random, bodies);
  for (int b = 0; b < bodies.size(); ++b) fix(bodies, b);
  const Bodies before = bodies;
  EXPECT_TRUE(trial->visit(bodies));
  for (int b = 0; b < bodies.size(); ++b) EXPECT_TRUE(sameBits(before.pose[b], bodies.pose[b]));
  EXPECT_EQ(trial->total(), 0);
}

TEST_P(EveryKind, RestsWhenSatisfied) {
  Random random(15);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    trial->satisfy(bodies);
    const Bodies before = bodies;
    for (int k = 0; k < 10; ++k) trial->visit(bodies);
    for (int b = 0; b < bodies.size(); ++b) {  // c itself is rounded to 1e-15
      EXPECT_LT(distance(before.pose[b], bodies.pose[b]), 3e-14);
    }
  }
}

TEST_P(EveryKind, IsTheSameWithItsBodiesSwapped) {
  Random random(16);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    trial->makeScalar();
    const auto swapped = trial->swapped(bodies);
    Bodies other = bodies;
    trial->visit(bodies);
    swapped->visit(other);
    for (int b = 0; b < bodies.size(); ++b) {
      EXPECT_LT(distance(bodies.pose[b], other.pose[b]), 1e-12) << n;
    }
    const double total = trial->total();
    EXPECT_NEAR(total, swapped->total(), 1e-12 * (1 + total));
  }
}

TEST_P(EveryKind, EndsWithoutResidual) {
  Random random(17);
  for (int n = 0; n < 50; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    trial->iterate(bodies, 200);
    EXPECT_LT(trial->residual(bodies), 1e-10 * (1 + trial->total())) << n;
  }
}

// K is how fast the force falls off: along a displacement of c it must be the force's own
// derivative, or less where that would be negative (point gravity along the line, a panel that
// turns).
TEST_P(EveryKind, ForceFallsOffAsItsStiffnessSays) {
  Random random(18);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    trial->toGradient(random, bodies);
    const std::optional<Mat3> k = trial->stiffness(bodies);
    if (!k) GTEST_SKIP() << "no force";
    const Vec3 eigenvalues = Eigen::SelfAdjointEigenSolver<Mat3>(*k).eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1e-12 * eigenvalues.cwiseAbs().maxCoeff());
    EXPECT_LT((*k - k->transpose()).norm(), 1e-14 * (1 + k->norm()));
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind, ::testing::ValuesIn(kindsOfTrials()), wordOf);

}  // namespace
}  // namespace physics::testing
