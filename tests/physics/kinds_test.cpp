// What every kind promises: momenta, rest, bodies that do not move, and an end without residual.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstring>

#include "physics/constraints/frozen_row.h"
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
    Bodies bodies = randomBodies(random, countOf<Item>());
    const Item item = Case<Item>::make(random, bodies);
    const Bodies before = bodies;
    Multipliers<Item> lambda;
    ASSERT_TRUE(visit(item, lambda, bodies));
    EXPECT_GT(distance(before.pose.back(), bodies.pose.back()), 1e-6);
  }
}

// Methods that solve frozen rows see what the kind itself says: c, J, bounds, A, and its bodies.
TYPED_TEST(EveryKind, IsFrozenAsItIsEvaluated) {
  using Item = typename TypeParam::Item;
  Random random(19);
  Bodies bodies = randomBodies(random, countOf<Item>());
  const Item item = Case<Item>::make(random, bodies);
  Kinds kinds;
  auto& set = std::get<TypeParam>(kinds).set;
  set.items.push_back(item);
  set.lambda.emplace_back();
  set.tuned.push_back({1, 0});
  const Evaluated<Item> own = rowOf(item, bodies);
  FrozenRows rows;
  int lists = 0;
  forEachList(kinds, rows, [&](auto& list, const KindPlace& kind) {
    ++lists;
    EXPECT_STREQ(kind.word, TypeParam::kWord);
    ASSERT_EQ(kind.count, 1U);
    list.resize(1);
    auto& frozen = list[0];
    evaluate(kinds, kind.place, 0, {bodies.pose, bodies.start, 1.0 / 60}, frozen);
    if constexpr (std::is_same_v<std::decay_t<decltype(frozen)>, FrozenOf<Item>>) {
      EXPECT_EQ(frozen.total, &set.lambda[0].total);
      EXPECT_TRUE(std::equal(frozen.bodies.begin(), frozen.bodies.end(), item.bodies.begin()));
      EXPECT_EQ(frozen.row.c, own.c);
      EXPECT_EQ(frozen.row.longest, own.longest);
      Response<Item> response;
      EXPECT_EQ(effectiveMassInverse(frozen, frozen.row, bodies.inverse, frozen.response),
                effectiveMassInverse(item, own, bodies.inverse, response));
      if constexpr (Force<Item>) {
        EXPECT_EQ(frozen.row.f, own.f);
        EXPECT_EQ(frozen.row.k, own.k);
      } else {
        EXPECT_EQ(frozen.row.alpha, own.alpha);
        EXPECT_EQ(frozen.row.low, own.low);
        EXPECT_EQ(frozen.row.high, own.high);
      }
    } else {
      ADD_FAILURE() << "rows of another shape";
    }
  });
  EXPECT_EQ(lists, 1);
}

TYPED_TEST(EveryKind, KeepsLinearMomentum) {
  using Item = typename TypeParam::Item;
  if (isExternal<Item>()) GTEST_SKIP() << "a force of the surroundings";
  Random random(11);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomBodies(random, countOf<Item>());
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
  if (isExternal<Item>()) GTEST_SKIP() << "a force of the surroundings";
  Random random(12);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomBodies(random, countOf<Item>());
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
    Bodies bodies = randomBodies(random, countOf<Item>());
    const Item item = Case<Item>::make(random, bodies);
    const int fixed = n % bodies.size(), other = (fixed + 1) % bodies.size();
    fix(bodies, fixed);
    const Bodies before = bodies;
    Multipliers<Item> lambda;
    for (int k = 0; k < 3; ++k) visit(item, lambda, bodies);
    EXPECT_TRUE(sameBits(before.pose[fixed], bodies.pose[fixed]));
    if (other != fixed) {
      EXPECT_FALSE(sameBits(before.pose[other], bodies.pose[other]));
    }
  }
}

TYPED_TEST(EveryKind, DoesNothingBetweenImmovableBodies) {
  using Item = typename TypeParam::Item;
  Random random(14);
  Bodies bodies = randomBodies(random, countOf<Item>());
  const Item item = Case<Item>::make(random, bodies);
  for (int b = 0; b < bodies.size(); ++b) fix(bodies, b);
  const Bodies before = bodies;
  Multipliers<Item> lambda;
  EXPECT_TRUE(visit(item, lambda, bodies));
  for (int b = 0; b < bodies.size(); ++b) EXPECT_TRUE(sameBits(before.pose[b], bodies.pose[b]));
  EXPECT_TRUE(lambda.total.isZero(0));
}

TYPED_TEST(EveryKind, RestsWhenSatisfied) {
  using Item = typename TypeParam::Item;
  Random random(15);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomBodies(random, countOf<Item>());
    Item item = Case<Item>::make(random, bodies);
    Case<Item>::satisfy(item, bodies);
    const Bodies before = bodies;
    Multipliers<Item> lambda;
    for (int k = 0; k < 10; ++k) visit(item, lambda, bodies);
    for (int b = 0; b < bodies.size(); ++b) {  // c itself is rounded to 1e-15
      EXPECT_LT(distance(before.pose[b], bodies.pose[b]), 3e-14);
    }
  }
}

TYPED_TEST(EveryKind, IsTheSameWithItsBodiesSwapped) {
  using Item = typename TypeParam::Item;
  Random random(16);
  for (int n = 0; n < kSamples; ++n) {
    Bodies bodies = randomBodies(random, countOf<Item>());
    Item item = Case<Item>::make(random, bodies);
    makeScalar(item);
    Item swapped = Case<Item>::swapped(item, bodies);
    std::reverse(swapped.bodies.begin(), swapped.bodies.end());
    Bodies other = bodies;
    Multipliers<Item> lambda, otherLambda;
    visit(item, lambda, bodies);
    visit(swapped, otherLambda, other);
    for (int b = 0; b < bodies.size(); ++b) {
      EXPECT_LT(distance(bodies.pose[b], other.pose[b]), 1e-12) << n;
    }
    EXPECT_NEAR(lambda.total.norm(), otherLambda.total.norm(), 1e-12 * (1 + lambda.total.norm()));
  }
}

TYPED_TEST(EveryKind, EndsWithoutResidual) {
  using Item = typename TypeParam::Item;
  Random random(17);
  for (int n = 0; n < 50; ++n) {
    Bodies bodies = randomBodies(random, countOf<Item>());
    const Item item = Case<Item>::make(random, bodies);
    const Multipliers<Item> lambda = iterate(item, bodies, 200);
    EXPECT_LT(residualOf(item, lambda, bodies), 1e-10 * (1 + lambda.total.norm())) << n;
  }
}

// K is how fast the force falls off: along a displacement of c it must be the force's own
// derivative, or less where that would be negative (point gravity along the line, a panel that
// turns).
TYPED_TEST(EveryKind, ForceFallsOffAsItsStiffnessSays) {
  using Item = typename TypeParam::Item;
  if constexpr (Force<Item>) {
    Random random(18);
    for (int n = 0; n < kSamples; ++n) {
      Bodies bodies = randomBodies(random, countOf<Item>());
      const Item item = Case<Item>::make(random, bodies);
      Case<Item>::toGradient(item, random, bodies);
      const auto push = rowOf(item, bodies);
      const Eigen::SelfAdjointEigenSolver<typename std::decay_t<decltype(push)>::Matrix> eigen(
          push.k);
      EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().cwiseAbs().maxCoeff());
      EXPECT_LT((push.k - push.k.transpose()).norm(), 1e-14 * (1 + push.k.norm()));
    }
  }
}

}  // namespace
}  // namespace physics::testing
