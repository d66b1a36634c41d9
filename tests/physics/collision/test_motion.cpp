// Moving bodies: what is found ahead of time, and what must not be.
#include <gtest/gtest.h>

#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

const Vec3 kX = Vec3::UnitX(), kY = Vec3::UnitY(), kZ = Vec3::UnitZ();

// Two bodies, the first moving from `start` to `end`, the second at rest.
std::vector<Manifold> pass(const Shape& a, const Pose& start, const Pose& end, const Shape& b,
                           const Pose& poseB, double margin = 0.01) {
  Collider collider;
  collider.add(1, a, true);
  collider.add(2, b, false);
  const std::vector<Pose> from = {Pose{}, start, poseB}, to = {Pose{}, end, poseB};
  const auto found = collider.find(from, to, margin);
  return {found.begin(), found.end()};
}
std::vector<Manifold> pass(const Shape& a, const Vec3& start, const Vec3& end, const Shape& b,
                           double margin = 0.01) {
  return pass(a, {start, Quat::Identity()}, {end, Quat::Identity()}, b, {}, margin);
}

const Box kWall{Vec3(0.2, 4, 4)};

TEST(Motion, FastSphereIsFoundAtFirstTouchOfAThinBox) {  // 100 m/s, dt = 1/30: 3.3 m
  const std::vector<Pose> start = {Pose{}, {Vec3(-1.5, .2, .1), Quat::Identity()}, Pose{}};
  const auto found = pass(Sphere{.1}, start[1], {Vec3(1.83, .2, .1), Quat::Identity()}, kWall, {});
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].count, 1);
  const Point point = place(found[0], 0, start);
  EXPECT_NEAR((point.n + kX).norm(), 0, 1e-12);
  EXPECT_NEAR(point.gap, 1.5 - .1 - .1, 1e-12);
}

TEST(Motion,
     FastSphereHitsTheSideItReachesFirst) {  // from above at a slope, not the nearest face at start
  const Box block{Vec3(2, 1, 2)};
  const auto found = pass(Sphere{.1}, Vec3(-1.3, 1.4, 0), Vec3(1.3, -.5, 0), block);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR((found[0].normal - kY).norm(), 0, 1e-12);
}

TEST(Motion, FastTurnedBoxMeetsTheWallWithItsNormal) {
  const Pose start{Vec3(-2, 0, 0), turned(Vec3(1, 2, 3), 50)};
  const auto found = pass(Box{Vec3(.3, .3, .3)}, start, {Vec3(2, 0, 0), start.q}, kWall, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR((found[0].normal + kX).norm(), 0, 1e-12);
}

TEST(Motion, TwoFastSpheresMeetHalfWay) {
  Collider collider;
  collider.add(1, Sphere{.1}, true);
  collider.add(2, Sphere{.1}, true);
  const Quat q = Quat::Identity();
  const std::vector<Pose> from = {Pose{}, {Vec3(-2, 0, 0), q}, {Vec3(2, .1, 0), q}};
  const std::vector<Pose> to = {Pose{}, {Vec3(2, 0, 0), q}, {Vec3(-2, .1, 0), q}};
  const auto found = collider.find(from, to, 0.01);
  ASSERT_EQ(found.size(), 1u);
  const Vec3 n(-std::sqrt(.03), -.1,
               0);  // centres 0.2 apart at touch; the touch is found 1 mm early
  EXPECT_NEAR((found[0].normal - n.normalized()).norm(), 0, 0.01);
}

TEST(Motion, NothingIsFoundBesideThePath) {  // ball and box 0.2 m apart when nearest
  EXPECT_TRUE(pass(Sphere{.1}, Vec3(-1, .8, 0), Vec3(1, .8, 0), Box{}).empty());
  EXPECT_TRUE(pass(Box{Vec3(.2, .2, .2)}, Vec3(-1, .8, 0), Vec3(1, .8, 0), Box{}).empty());
  EXPECT_TRUE(pass(Capsule{.1, .2}, Vec3(-1, .9, 0), Vec3(1, .9, 0), wedge()).empty());
  EXPECT_TRUE(pass(Cylinder{.1, .2}, Vec3(-1, .8, 0), Vec3(1, .8, 0), Sphere{.5}).empty());
}

TEST(Motion, NothingIsFoundBehindOrShortOfAFastBody) {
  EXPECT_TRUE(pass(Sphere{.1}, Vec3(1, 0, 0), Vec3(4, 0, 0), kWall).empty());
  EXPECT_TRUE(pass(Sphere{.1}, Vec3(-4, 0, 0), Vec3(-1, 0, 0), kWall).empty());
}

TEST(Motion, FastBoxThroughAPlaneIsFoundWithItsCorners) {
  const std::vector<Pose> start = {Pose{}, {Vec3(0, 3, 0), Quat::Identity()}, Pose{}};
  const auto found = pass(Box{}, start[1], {Vec3(0, -3, 0), Quat::Identity()}, Plane{}, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].count, 4);
  EXPECT_NEAR(smallestGap(found[0], start), 2.5, 1e-12);
}

TEST(Motion, FallingBoxLandsOnFourPoints) {
  const auto found = pass(Box{}, Vec3(0, 1.06, 0), Vec3(0, .94, 0), Box{Vec3(2, 1, 2)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].count, 4);
}

TEST(Motion, OfATouchAtTheStartIsIgnored) {  // the start decides, whatever the end
  const std::vector<Pose> start = {Pose{}, {Vec3(0, 1, 0), Quat::Identity()}, Pose{}};
  const auto found = pass(Box{}, start[1], {Vec3(0, 5, 0), Quat::Identity()}, Box{}, {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(smallestGap(found[0], start), 0, 1e-12);
}

TEST(Motion, ASpinningRodIsFoundWhereItsEndSweeps) {
  const Pose start{Vec3(0, 1, 0), Quat::Identity()}, end{start.x, turned(kZ, 90)};
  const auto found =
      pass(Capsule{.05, 2}, start, end, Sphere{.2}, {Vec3(-.8, 1.6, 0), Quat::Identity()});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(
      pass(Capsule{.05, 2}, start, end, Sphere{.2}, {Vec3(.8, 1.6, 0), Quat::Identity()}).empty());
}

TEST(Motion, ARollingSphereKeepsItsGap) {
  const std::vector<Pose> start = {Pose{}, {Vec3(0, .3, 0), Quat::Identity()}, Pose{}};
  const auto found = meet(Sphere{.3}, start[1], Plane{}, start[2]);
  ASSERT_EQ(found.size(), 1u);
  const std::vector<Pose> rolled = {Pose{}, {Vec3(.4, .3, 0), turned(Vec3(3, 1, 2), 77)}, Pose{}};
  EXPECT_NEAR(smallestGap(found[0], rolled), 0, 1e-15);
}

TEST(Motion, ARollingCylinderKeepsItsGap) {
  const std::vector<Pose> start = {Pose{}, {Vec3(0, .25, 0), turned(kX, 90)}, Pose{}};
  const auto found = meet(Cylinder{.25, 1}, start[1], Plane{}, start[2]);
  ASSERT_EQ(found.size(), 1u);
  const std::vector<Pose> rolled = {
      Pose{}, {Vec3(.4, .25, 0), turned(kZ, -77) * start[1].q}, Pose{}};
  EXPECT_NEAR(smallestGap(found[0], rolled), 0, 1e-15);
}

TEST(Motion, ATiltedCylinderTouchesWithItsLowestRimPoint) {
  for (const double tilt : {1.0, 7.0, 30.0, 59.0, 61.0, 80.0, 89.0}) {
    std::vector<Pose> poses = {Pose{}, {Vec3::Zero(), turned(kY, 23) * turned(kX, tilt)}, Pose{}};
    const Cylinder can{.25, .5};
    poses[1].x.y() = -supportOf(can, poses[1], -kY).y();
    const auto found = meet(can, poses[1], Plane{}, poses[2]);
    ASSERT_EQ(found.size(), 1u) << tilt;
    EXPECT_NEAR(smallestGap(found[0], poses), 0, 1e-12) << tilt;
  }
}

}  // namespace
}  // namespace physics
