// Boxes, and capsules on boxes, against the same solids given as hulls: those take the general way.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/bodies/hull.h"
#include "physics/collision/soft_collider.h"
#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

constexpr double kMargin = 0.05;

Convex asHull(const Box& box) { return {std::make_shared<const Hull>(boxHull(0.5 * box.size))}; }

// Turned at random, or nearly upright, as in a pile.
Pose nearby(Random& random, bool upright) {
  Pose pose = random.pose(1.2);
  if (upright) pose.q = random.lean(0, 2);
  return pose;
}

void expectSame(const std::vector<Manifold>& found, const std::vector<Manifold>& general,
                const std::vector<Pose>& poses) {
  ASSERT_EQ(found.size(), general.size());
  if (found.empty()) return;
  EXPECT_LT((found[0].normal - general[0].normal).norm(), 1e-9);
  EXPECT_NEAR(smallestGap(found[0], poses), smallestGap(general[0], poses), 1e-9);
}

TEST(BoxFace, IsThatOfTheSameHull) {
  Random random(7);
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    const Box a{Vec3(1, 0.6, 0.8)}, b{Vec3(0.9, 1.1, 0.7)};
    const std::vector<Pose> poses = {{}, nearby(random, i % 2 == 0), nearby(random, i % 2 == 0)};
    SCOPED_TRACE(i);
    const auto found = meet(a, poses[1], b, poses[2], kMargin);
    expectSame(found, meet(asHull(a), poses[1], asHull(b), poses[2], kMargin), poses);
    met += static_cast<int>(found.size());
  }
  EXPECT_GT(met, 1000);
}

TEST(BoxFace, BearsACapsuleAsTheSameHullDoes) {
  Random random(8);
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    const Capsule a{0.1, 0.7};
    const Box b{Vec3(0.9, 1.1, 0.7)};
    const std::vector<Pose> poses = {{}, nearby(random, i % 2 == 0), nearby(random, i % 2 == 0)};
    SCOPED_TRACE(i);
    const auto found = meet(a, poses[1], b, poses[2], kMargin);
    expectSame(found, meet(a, poses[1], asHull(b), poses[2], kMargin), poses);
    met += static_cast<int>(found.size());
  }
  EXPECT_GT(met, 1000);
}

// Its ends are two metres apart, the box between them is small.
TEST(BoxFace, BearsTheMiddleOfALink) {
  SoftCollider collider;
  collider.addBody(1, Box{Vec3(0.2, 0.2, 0.2)});
  SoftElement link;
  link.from = 2;
  link.to = 3;
  link.radius = 0.01;
  collider.addElement(link);
  const std::vector<Pose> poses = {
      {}, {}, {Vec3(-1, 0.12, 0), Quat::Identity()}, {Vec3(1, 0.12, 0), Quat::Identity()}};
  const auto touches = collider.find(poses, poses, kMargin);
  ASSERT_EQ(touches.size(), 2u);
  for (const SoftTouch& touch : touches) {
    EXPECT_NEAR(touch.gap, 0.01, 1e-12);
    EXPECT_NEAR(std::abs(touch.along - 0.5), 0.05, 1e-4);  // kSideTolerance of the sizes
  }
}

}  // namespace
}  // namespace physics
