// What every kind promises: momenta, rest, bodies that do not move, and an end without residual.
#include <cstring>

#include "tests/physics/kind_cases.h"

namespace physics::testing {
namespace {

constexpr int kSamples = 200;

template <class Item>
void makeScalar(Item& item) {
  if constexpr (requires { item.form; }) item.form = Form::kScalar;
}

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

template <class K>
class EveryKind : public ::testing::Test {};
TYPED_TEST_SUITE(EveryKind, ListOf<Kinds>::Types, KindName);

TYPED_TEST(EveryKind, MovesSomethingWhenViolated) {
  using Item = typename TypeParam::Item;
  Random random(10);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomPair(random);
    const Item item = Case<Item>::make(random, bodies);
    const Bodies before = bodies;
    Multipliers<Item> lambda;
    ASSERT_TRUE(visit(item, lambda, bodies));
    EXPECT_GT(distance(before.pose[1], bodies.pose[1]), 1e-6);
  }
}

TYPED_TEST(EveryKind, KeepsLinearMomentum) {
  using Item = typename TypeParam::Item;
  Random random(11);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomPair(random);
    const Item item = Case<Item>::make(random, bodies);
    const Bodies before = bodies;
    Multipliers<Item> lambda;
    visit(item, lambda, bodies);
    const Momenta sum = given(before, bodies);
    // Positions of a few metres hold displacements to 1e-15.
    EXPECT_LE(sum.linear.norm(), 1e-13 * std::max(1.0, sum.linearScale));
  }
}

// About the points where the impulses act. In the vector form of a ball the open gap is a lever:
// BallSocket.VectorFormTurnsThePairByTheGapTimesTheImpulse.
TYPED_TEST(EveryKind, KeepsAngularMomentumOfThePair) {
  using Item = typename TypeParam::Item;
  Random random(12);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomPair(random);
    Item item = Case<Item>::make(random, bodies);
    makeScalar(item);
    const Bodies before = bodies;
    Multipliers<Item> lambda;
    visit(item, lambda, bodies);
    for (const Pose& pose : bodies.pose) ASSERT_GT(pose.q.norm(), 0);
    const Momenta sum = given(before, bodies);
    EXPECT_LE(sum.angular.norm(), 1e-12 * std::max(1.0, sum.angularScale)) << n;
  }
}

TYPED_TEST(EveryKind, LeavesAnImmovableBodyAsItIsToTheBit) {
  using Item = typename TypeParam::Item;
  Random random(13);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomPair(random);
    const Item item = Case<Item>::make(random, bodies);
    fix(bodies, n % 2);
    const Bodies before = bodies;
    Multipliers<Item> lambda;
    for (int k = 0; k < 3; ++k) visit(item, lambda, bodies);
    EXPECT_TRUE(sameBits(before.pose[n % 2], bodies.pose[n % 2]));
    EXPECT_FALSE(sameBits(before.pose[1 - n % 2], bodies.pose[1 - n % 2]));
  }
}

TYPED_TEST(EveryKind, DoesNothingBetweenTwoImmovableBodies) {
  using Item = typename TypeParam::Item;
  Random random(14);
  Bodies bodies = randomPair(random);
  const Item item = Case<Item>::make(random, bodies);
  fix(bodies, 0);
  fix(bodies, 1);
  const Bodies before = bodies;
  Multipliers<Item> lambda;
  EXPECT_TRUE(visit(item, lambda, bodies));
  EXPECT_TRUE(sameBits(before.pose[0], bodies.pose[0]) && sameBits(before.pose[1], bodies.pose[1]));
  EXPECT_TRUE(lambda.total.isZero(0));
}

TYPED_TEST(EveryKind, RestsWhenSatisfied) {
  using Item = typename TypeParam::Item;
  Random random(15);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomPair(random);
    Item item = Case<Item>::make(random, bodies);
    Case<Item>::satisfy(item, bodies);
    const Bodies before = bodies;
    Multipliers<Item> lambda;
    for (int k = 0; k < 10; ++k) visit(item, lambda, bodies);
    for (int b = 0; b < 2; ++b) {  // c itself is rounded to 1e-15
      EXPECT_LT(distance(before.pose[b], bodies.pose[b]), 3e-14);
    }
  }
}

TYPED_TEST(EveryKind, IsTheSameWithItsBodiesSwapped) {
  using Item = typename TypeParam::Item;
  Random random(16);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomPair(random);
    Item item = Case<Item>::make(random, bodies);
    makeScalar(item);
    Item swapped = Case<Item>::swapped(item, bodies);
    std::swap(swapped.bodies[0], swapped.bodies[1]);
    Bodies other = bodies;
    Multipliers<Item> lambda, otherLambda;
    visit(item, lambda, bodies);
    visit(swapped, otherLambda, other);
    for (int b = 0; b < 2; ++b) EXPECT_LT(distance(bodies.pose[b], other.pose[b]), 1e-12) << n;
    EXPECT_NEAR(lambda.total.norm(), otherLambda.total.norm(), 1e-12 * (1 + lambda.total.norm()));
  }
}

TYPED_TEST(EveryKind, EndsWithoutResidual) {
  using Item = typename TypeParam::Item;
  Random random(17);
  for (int n = 0; n < 50; ++n) {
    Bodies bodies = randomPair(random);
    const Item item = Case<Item>::make(random, bodies);
    const Multipliers<Item> lambda = iterate(item, bodies, 200);
    const auto row = rowOf(item, bodies);
    // c is already divided by the compliance's scale: for forces it is an impulse times alpha.
    const double residual = (row.c + row.alpha * lambda.total).norm();
    EXPECT_LT(residual, 1e-10 * (1 + row.alpha * lambda.total.norm())) << n;
  }
}

}  // namespace
}  // namespace physics::testing
