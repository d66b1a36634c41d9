// The volume of a tetrahedron, (140)-(142).
#include "physics/constraints/volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

const std::array<Vec3, 4> kRegular = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, -std::sqrt(3) / 2),
                                      Vec3(0.5, std::sqrt(2.0 / 3), -std::sqrt(3) / 6)};
const double kVolume = 1 / (6 * std::sqrt(2));

Bodies pointsAt(const std::array<Vec3, 4>& corners) {
  Bodies bodies;
  for (const Vec3& x : corners) add(bodies, {1, Vec3::Zero(), at(x)});
  return bodies;
}

std::array<Vec3, 4> squashed(double height) {
  std::array<Vec3, 4> corners = kRegular;
  corners[3].y() *= height;
  return corners;
}

double volumeNow(const Bodies& bodies) {
  return volumeOf({bodies.pose[0].x, bodies.pose[1].x, bodies.pose[2].x, bodies.pose[3].x});
}

TEST(Volume, IsThatOfTheRegularTetrahedron) { EXPECT_NEAR(volumeOf(kRegular), kVolume, 1e-15); }

// Newton on a cubic: from 30 % of the height, NOTES 3.9.
TEST(Volume, IsRestoredInThreeIterations) {
  Bodies bodies = pointsAt(squashed(0.3));
  const Volume item{{0, 1, 2, 3}, kVolume};
  Multipliers<Volume> lambda;
  for (const double expected : {1.239, 1.0145, 1.00007, 1.0}) {
    visit(item, lambda, bodies);
    EXPECT_NEAR(volumeNow(bodies) / kVolume, expected, 6e-5 * expected + 5e-4 * (expected > 1.1));
  }
}

TEST(Volume, LeavesTheCentreOfMass) {
  Bodies bodies = pointsAt(squashed(0.3));
  Vec3 before = Vec3::Zero(), after = Vec3::Zero();
  for (const Pose& pose : bodies.pose) before += pose.x;
  iterate(Volume{{0, 1, 2, 3}, kVolume}, bodies, 4);
  for (const Pose& pose : bodies.pose) after += pose.x;
  EXPECT_LT((after - before).norm(), 1e-15);
}

TEST(Volume, InflatesAFlatTetrahedronAndRightsAnInvertedOne) {
  for (const double height : {0.0, -1.0, -0.1}) {
    Bodies bodies = pointsAt(squashed(height));
    iterate(Volume{{0, 1, 2, 3}, kVolume}, bodies, 30);
    EXPECT_NEAR(volumeNow(bodies), kVolume, 1e-12) << height;
  }
}

TEST(Volume, LeavesFourPointsOnALineAlone) {
  Bodies bodies = pointsAt({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(4, 0, 0)});
  const Bodies before = bodies;
  Multipliers<Volume> lambda;
  EXPECT_TRUE(visit(Volume{{0, 1, 2, 3}, kVolume}, lambda, bodies));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(bodies.pose[i].x, before.pose[i].x);
}

TEST(Volume, SolvesTetrahedraOfANanometre) {
  std::array<Vec3, 4> corners = squashed(0.5);
  for (Vec3& x : corners) x *= 1e-9;
  Bodies bodies = pointsAt(corners);
  iterate(Volume{{0, 1, 2, 3}, 1e-27 * kVolume}, bodies, 6);
  EXPECT_NEAR(volumeNow(bodies) / (1e-27 * kVolume), 1, 1e-9);
}

// (142) without the factor 1/4 of the resistance, and with V for 6 V.
double printed142(bool sixfold, int iterations) {
  Bodies bodies = pointsAt(squashed(0.9));
  for (int k = 0; k < iterations; ++k) {
    const auto row = rowOf(Volume{{0, 1, 2, 3}, kVolume}, bodies);
    double sum = 0;  // of |A_i|^2
    for (const auto& gradient : row.linear) sum += gradient.squaredNorm() / 4;
    const double c = sixfold ? row.c[0] : volumeNow(bodies) - 6 * kVolume;
    const double resistance = sixfold ? 1 / sum : 0.25 / sum;
    for (int i = 0; i < 4; ++i) bodies.pose[i].x -= resistance * c * row.linear[i].transpose();
  }
  return volumeNow(bodies) / kVolume - 1;
}

TEST(Erratum142, WithoutTheQuarterItOvershoots) {
  EXPECT_GT(std::abs(printed142(true, 3)), 1);
  Bodies bodies = pointsAt(squashed(0.9));
  iterate(Volume{{0, 1, 2, 3}, kVolume}, bodies, 3);
  EXPECT_NEAR(volumeNow(bodies) / kVolume, 1, 1e-9);
}

TEST(Erratum142, WithVForSixVItGrowsToAnotherVolume) { EXPECT_GT(printed142(false, 60), 2.5); }

}  // namespace
}  // namespace physics::testing
