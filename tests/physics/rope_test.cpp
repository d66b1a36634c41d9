// Links and the total length of a rope, (133)-(139).
#include <gtest/gtest.h>

#include "physics/constraints/link.h"
#include "physics/constraints/rope_length.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

const Vec3 kNone = Vec3::Zero();

BodyOf node(const Vec3& x) { return {1, Vec3::Zero(), at(x)}; }
BodyOf pin(const Vec3& x) { return {0, Vec3::Zero(), at(x)}; }

// Figure 6: ends held at +-a, links of length 1, the middle moved to height y.
Bodies threeNodes(double a, double y) {
  return bodiesOf({pin({-a, 0, 0}), node({0, y, 0}), pin({a, 0, 0})});
}

struct ThreeNodes {
  Bodies bodies;
  bool total;
  Multipliers<Link> left, right;
  Multipliers<RopeLength> all;

  ThreeNodes(double a, double y, bool withTotal) : bodies(threeNodes(a, y)), total(withTotal) {}

  double error() const {  // sum of |c| over the links
    return std::abs(rowOf(Link{{0, 1}, 1}, bodies).c[0]) +
           std::abs(rowOf(Link{{1, 2}, 1}, bodies).c[0]);
  }
  void iterate() {
    if (total) {
      visit(RopeLength{{0, 1, 2}, 2, false}, all, bodies);
    } else {
      visit(Link{{0, 1}, 1}, left, bodies);
      visit(Link{{1, 2}, 1}, right, bodies);
    }
  }
  double shareAfterOne() {
    const double before = error();
    iterate();
    return error() / before;
  }
  int iterationsTo(double share) {
    const double wanted = share * error();
    int count = 0;
    for (; error() > wanted && count < 1000; ++count) iterate();
    return count;
  }
};

TEST(RopeLength, SolvesInOneIterationWhatLinksTakeMany) {
  EXPECT_NEAR(ThreeNodes(0.98, -0.25, false).shareAfterOne(), 0.83, 0.01);
  EXPECT_NEAR(ThreeNodes(0.98, -0.25, true).shareAfterOne(), 0.087, 0.001);
  EXPECT_NEAR(ThreeNodes(0.95, -0.6, false).shareAfterOne(), 0.42, 0.01);
  EXPECT_NEAR(ThreeNodes(0.95, -0.6, true).shareAfterOne(), 0.15, 0.01);
}

TEST(RopeLength, TakesTwoIterationsToOnePercentWhereLinksTakeDozens) {
  EXPECT_EQ(ThreeNodes(0.98, -0.25, false).iterationsTo(0.01), 26);
  EXPECT_EQ(ThreeNodes(0.98, -0.25, true).iterationsTo(0.01), 2);
  EXPECT_EQ(ThreeNodes(0.99, -0.2, false).iterationsTo(0.01), 49);
  EXPECT_EQ(ThreeNodes(0.99, -0.2, true).iterationsTo(0.01), 2);
}

TEST(RopeLength, ConvergesQuadratically) {
  ThreeNodes nodes(0.98, -0.25, true);
  double last = nodes.error();
  for (int k = 0; k < 3; ++k) {
    nodes.iterate();
    EXPECT_LT(nodes.error(), 10 * last * last);  // Newton in one dimension: 1/(2 (2 y)^2)
    last = nodes.error();
  }
}

TEST(RopeLength, AloneLeavesAnOffCentreNodeOnItsEllipse) {
  Bodies bodies = threeNodes(0.9, -0.3);
  bodies.pose[1].x.x() = 0.25;
  iterate(RopeLength{{0, 1, 2}, 2, false}, bodies, 20);
  EXPECT_GT(std::abs(bodies.pose[1].x.x()), 0.2);
  EXPECT_LT(std::abs(rowOf(RopeLength{{0, 1, 2}, 2, false}, bodies).c[0]), 1e-12);
}

TEST(RopeLength, MovesOnlyTheEndsOfAStraightRope) {
  Bodies bodies;
  for (int i = 0; i < 6; ++i) add(bodies, node({0.1 * i, 0, 0}));
  const Bodies before = bodies;
  iterate(RopeLength{{0, 1, 2, 3, 4, 5}, 0.4, false}, bodies, 1);
  EXPECT_NEAR(bodies.pose[0].x.x(), 0.05, 1e-15);
  EXPECT_NEAR(bodies.pose[5].x.x(), 0.45, 1e-15);
  for (int i = 1; i < 5; ++i) EXPECT_EQ(bodies.pose[i].x, before.pose[i].x);
}

TEST(RopeLength, LeavesASlackRopeAlone) {
  Bodies bodies = threeNodes(0.5, -0.1);
  const Bodies before = bodies;
  iterate(RopeLength{{0, 1, 2}, 2, true}, bodies, 3);
  EXPECT_EQ(bodies.pose[1].x, before.pose[1].x);
}

TEST(RopeLength, DoesNothingWhereAStraightRopeIsHeldAtBothEnds) {
  Bodies bodies = bodiesOf({pin({-1, 0, 0}), node(kNone), pin({1, 0, 0})});
  iterate(RopeLength{{0, 1, 2}, 1, false}, bodies, 3);
  EXPECT_EQ(bodies.pose[1].x, kNone);
}

// (137)-(139) as printed read d_{i,i-1} as x_i - x_{i-1}: then inner nodes get the sum of
// directions.
TEST(Erratum137, TheSecondDirectionPointsFromTheNodeBefore) {
  const Bodies bodies = bodiesOf({node({0, 0, 0}), node({1, 0, 0}), node({1, 1, 0})});
  const auto row = rowOf(RopeLength{{0, 1, 2}, 1, false}, bodies);
  const Vec3 d12 = Vec3(-1, 0, 0), d23 = Vec3(0, -1, 0);
  EXPECT_LT((row.linear[1].transpose() - (d23 - d12)).norm(), 1e-15);
  const Vec3 printed = d23 - Vec3(1, 0, 0);  // d_21 = x_2 - x_1
  const double h = 1e-6;
  Bodies ahead = bodies, behind = bodies;
  ahead.pose[1].x.x() += h;
  behind.pose[1].x.x() -= h;
  const RopeLength rope{{0, 1, 2}, 1, false};
  const double slope = (rowOf(rope, ahead).c[0] - rowOf(rope, behind).c[0]) / (2 * h);
  EXPECT_NEAR(slope, (d23 - d12).x(), 1e-9);
  EXPECT_GT(std::abs(slope - printed.x()), 1.5);
}

TEST(Link, PartsCoincidentPointsAlongTheirLastDirection) {
  Bodies bodies = bodiesOf({node(kNone), node(kNone)});
  bodies.start[1].x = Vec3(0.3, 0, 0);
  iterate(Link{{0, 1}, 0.5}, bodies, 3);
  EXPECT_NEAR(bodies.pose[1].x.x(), 0.25, 1e-12);
  EXPECT_NEAR(bodies.pose[0].x.x(), -0.25, 1e-12);
}

TEST(Link, OfZeroLengthJoinsItsPoints) {
  Bodies bodies = bodiesOf({node(kNone), node({0.3, 0.1, 0})});
  iterate(Link{{0, 1}, 0}, bodies, 3);
  EXPECT_LT((bodies.pose[0].x - bodies.pose[1].x).norm(), 1e-12);
  EXPECT_TRUE(bodies.pose[0].x.allFinite());
}

TEST(Link, GivesWayByItsComplianceTimesTheTension) {
  Bodies bodies = bodiesOf({pin(kNone), node({1, 0, 0})});
  const double h = 1.0 / 60, compliance = 1e-3;
  bodies.pose[1].x.x() = 1.02;  // pulled by 0.02 m in one step: as by a force of 0.02 m/h^2
  const auto lambda = iterate(Link{{0, 1}, 1, compliance}, bodies, 4);
  const double stretch = bodies.pose[1].x.x() - 1;
  EXPECT_NEAR(stretch, -compliance * lambda.total[0] / (h * h), 1e-14);
}

}  // namespace
}  // namespace physics::testing
