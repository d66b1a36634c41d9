// Bodies of several shapes: their mass, and their parts in the collider.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/bodies/compound.h"
#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

PrincipalCompound twoHalves(const Vec3& size, double mass) {  // of a box, side by side along x
  const Vec3 half(size.x() / 2, size.y(), size.z());
  const std::vector<PartDef> parts = {
      {Box{half}, {Vec3(-size.x() / 4, 0, 0), Quat::Identity()}, mass / 2},
      {Box{half}, {Vec3(size.x() / 4, 0, 0), Quat::Identity()}, mass / 2}};
  return makeCompound(parts);
}

TEST(CompoundMass, OfTheHalvesOfABoxIsThatOfTheBox) {
  const Vec3 size(2, 0.5, 1);
  const PrincipalCompound made = twoHalves(size, 3);
  const MassProperties whole = massProperties(Box{size}), sum = massProperties(made.compound);
  EXPECT_DOUBLE_EQ(made.mass, 3);
  EXPECT_DOUBLE_EQ(sum.volume, whole.volume);
  EXPECT_NEAR((sum.inertiaPerMass - whole.inertiaPerMass).norm(), 0, 1e-15);
  EXPECT_TRUE(made.toParts.x.isZero(1e-15));
}

// A heavy ball and a light one, 1 m apart: the centre of mass divides the way 1 : 3, and about it
// the moment across is that of the reduced mass m1 m2 / (m1 + m2) = 0.75 kg.
TEST(CompoundMass, OfTwoBallsIsThatOfADumbbell) {
  const double r = 0.1, own = 0.4 * r * r;
  const std::vector<PartDef> parts = {{Sphere{r}, {Vec3(1, 2, 3), Quat::Identity()}, 3},
                                      {Sphere{r}, {Vec3(2, 2, 3), Quat::Identity()}, 1}};
  const PrincipalCompound made = makeCompound(parts);
  EXPECT_NEAR((made.toParts.x - Vec3(1.25, 2, 3)).norm(), 0, 1e-15);
  const Vec3 inertia = made.mass * massProperties(made.compound).inertiaPerMass;
  EXPECT_NEAR(inertia.x(), 4 * own, 1e-15);
  EXPECT_NEAR(inertia.y(), 4 * own + 0.75, 1e-15);
  EXPECT_NEAR(inertia.z(), 4 * own + 0.75, 1e-15);
}

TEST(CompoundMass, TurnsWithItsParts) {
  const Quat turn = turned(Vec3(1, 2, 3), 40);
  std::vector<PartDef> parts = {
      {Box{Vec3(1, 0.2, 0.4)}, {Vec3(0.5, 0, 0), turned(Vec3(0, 0, 1), 30)}, 1},
      {Capsule{0.1, 0.7}, {Vec3(0, 0.4, 0.1), Quat::Identity()}, 2}};
  const PrincipalCompound first = makeCompound(parts);
  for (PartDef& part : parts) part.pose = placed({Vec3(4, 5, 6), turn}, part.pose);
  const PrincipalCompound second = makeCompound(parts);
  EXPECT_NEAR((second.toParts.x - (Vec3(4, 5, 6) + turn * first.toParts.x)).norm(), 0, 1e-12);
  Vec3 moments[2] = {massProperties(first.compound).inertiaPerMass,
                     massProperties(second.compound).inertiaPerMass};
  for (Vec3& m : moments) std::sort(m.begin(), m.end());
  EXPECT_NEAR((moments[0] - moments[1]).norm(), 0, 1e-12);
  for (int i = 0; i < 2; ++i) {  // `toParts` takes the parts back
    const Pose back = placed(second.toParts, second.compound.parts->list[i].pose);
    EXPECT_NEAR((back.x - parts[i].pose.x).norm(), 0, 1e-12);
  }
}

// Of a table that stands askew in nothing but its legs the axes are near those of the file.
TEST(CompoundMass, HasAxesNearTheFrames) {
  const std::vector<PartDef> parts = {
      {Box{Vec3(2, 0.2, 0.9)}, {Vec3(0, 0, 0), Quat::Identity()}, 8},
      {Box{Vec3(0.4, 0.4, 0.4)}, {Vec3(0.3, 0.3, 0), Quat::Identity()}, 2}};
  EXPECT_LT(makeCompound(parts).toParts.q.angularDistance(Quat::Identity()), 0.2);
}

TEST(CompoundMass, RefusesPartsWithoutAVolume) {
  EXPECT_THROW(makeCompound({}), std::invalid_argument);
  const std::vector<PartDef> point = {{PointShape{}, {}, 1}};
  EXPECT_THROW(makeCompound(point), std::invalid_argument);
  const std::vector<PartDef> nested = {{twoHalves(Vec3::Ones(), 1).compound, {}, 1}};
  EXPECT_THROW(makeCompound(nested), std::invalid_argument);
  const std::vector<PartDef> light = {{Sphere{1}, {}, 0}};
  EXPECT_THROW(makeCompound(light), std::invalid_argument);
}

// Two boxes side by side touch a plane in the places where the one box would, and between.
TEST(CompoundCollision, EveryPartHasItsManifoldInTheBodysFrame) {
  const Pose pose{Vec3(1, 0.3, 2), turned(Vec3(0, 1, 0), 30)};
  const Compound halves = twoHalves(Vec3(2, 0.5, 1), 1).compound;
  const Plane ground{Vec3(0, 1, 0), 0};
  const std::vector<Manifold> found = meet(halves, pose, ground, Pose{}, 0.1);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_LT(found[0].pair, found[1].pair);
  const std::vector<Pose> poses = {Pose{}, pose, Pose{}};
  for (const Manifold& manifold : found) {
    EXPECT_EQ(manifold.count, 4);
    EXPECT_EQ(manifold.a, 1);
    for (int k = 0; k < manifold.count; ++k) {
      const Point point = place(manifold, k, poses);
      EXPECT_NEAR(point.gap, 0.05, 1e-12);
    }
  }
  EXPECT_NEAR(distanceOf(halves, pose, ground, Pose{}), 0.05, 1e-12);
}

TEST(CompoundCollision, TheNormalIsInTheFrameOfTheBodyThatCarriesIt) {
  const std::vector<PartDef> parts = {
      {Box{Vec3(1, 1, 1)}, {Vec3(0, 0, 0), turned(Vec3(0, 0, 1), 45)}, 1},
      {Box{Vec3(1, 1, 1)}, {Vec3(4, 0, 0), turned(Vec3(0, 0, 1), 20)}, 1}};
  const PrincipalCompound made = makeCompound(parts);
  const Quat tilt = turned(Vec3(0, 0, 1), -20);  // lays the second box flat
  const Pose body = placed({Vec3::Zero(), tilt}, made.toParts);
  const Vec3 top = tilt * Vec3(4, 0, 0) + Vec3(0, 0.5 + 0.25, 0);
  const Pose ball{top, Quat::Identity()};
  const std::vector<Manifold> found = meet(Sphere{0.25}, ball, made.compound, body, 0.01);
  ASSERT_EQ(found.size(), 1u);
  const std::vector<Pose> poses = {Pose{}, ball, body};
  const Point point = place(found[0], 0, poses);
  EXPECT_NEAR((point.n - Vec3(0, 1, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(point.gap, 0, 1e-9);
}

TEST(CompoundCollision, PartsOfABodyNeverTouchEachOther) {
  Collider collider;
  collider.add(1, twoHalves(Vec3(1, 1, 1), 1).compound, true);
  EXPECT_FALSE(collider.canTouch());
  const std::vector<Pose> poses(2);
  EXPECT_TRUE(collider.find(poses, poses, 0.1).empty());
}

TEST(CompoundCollision, IgnoringABodyIgnoresAllOfItsParts) {
  Collider collider;
  collider.add(1, twoHalves(Vec3(1, 1, 1), 1).compound, true);
  collider.add(2, Plane{}, false);
  EXPECT_TRUE(collider.canTouch());
  collider.ignore(1, 2);
  EXPECT_FALSE(collider.canTouch());
  const std::vector<Pose> poses(3);
  EXPECT_TRUE(collider.find(poses, poses, 0.1).empty());
}

TEST(CompoundCollision, RestsAndWakesWhole) {
  Collider collider;
  collider.add(1, twoHalves(Vec3(2, 1, 1), 1).compound, true);
  collider.add(2, Plane{}, false);
  std::vector<Pose> poses(3);
  poses[1].x.y() = 0.5;
  const std::array<BodyId, 2> both = {1, 2};
  collider.rest(both, poses);
  EXPECT_TRUE(collider.find(poses, poses, 0.1).empty());
  collider.wake(std::array<BodyId, 1>{1});
  EXPECT_EQ(collider.find(poses, poses, 0.1).size(), 2u);
}

// A thin part far from the centre of mass, swung through a post within one step.
TEST(CompoundCollision, AFastPartIsMetOnItsWay) {
  const std::vector<PartDef> parts = {{Sphere{0.05}, {Vec3(-1, 0, 0), Quat::Identity()}, 1},
                                      {Sphere{0.05}, {Vec3(1, 0, 0), Quat::Identity()}, 1}};
  const Compound dumbbell = makeCompound(parts).compound;
  Collider collider;
  collider.add(1, dumbbell, true);
  collider.add(2, Box{Vec3(0.2, 1, 0.02)}, false);
  std::vector<Pose> start(3), end(3);
  start[2].x = end[2].x = Vec3(1, 0, 0);
  start[1].x.z() = -1, end[1].x.z() = 1;
  EXPECT_EQ(collider.find(start, end, 0.01).size(), 1u);
}

}  // namespace
}  // namespace physics
