// A settled scene is detected without allocating.
#include <gtest/gtest.h>

#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

struct Heap {
  Collider collider;
  std::vector<Pose> poses = {Pose{}};
};

Heap heap() {
  Heap scene;
  const std::vector<Named> kinds = shapes();
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Shape& shape = kinds[static_cast<std::size_t>(i) % (kinds.size() - 1)].shape;
    scene.collider.add(i + 1, shape, true);
    const Vec3 cell(i % 6, i / 6 % 6, i / 36);
    scene.poses.push_back({0.45 * cell, random.rotation()});
  }
  scene.collider.add(201, Plane{}, false);
  scene.poses.emplace_back();
  return scene;
}

TEST(Allocation, NoneForBodiesAtRest) {
  Heap scene = heap();
  scene.collider.find(scene.poses, scene.poses, 0.02);
  const long before = allocationCount();
  const std::size_t found = scene.collider.find(scene.poses, scene.poses, 0.02).size();
  EXPECT_EQ(allocationCount(), before);
  EXPECT_GT(found, 100u);
}

TEST(Allocation, NoneForBodiesThatGoOnMoving) {  // there and back, out of their fat bounds
  Heap scene = heap();
  Random random(8);
  std::vector<Pose> other = scene.poses;
  for (std::size_t i = 1; i + 1 < other.size(); ++i) other[i].x += 0.2 * random.direction();
  for (int i = 0; i < 6; ++i) {
    scene.collider.find(i % 2 ? other : scene.poses, i % 2 ? scene.poses : other, 0.02);
  }
  const long before = allocationCount();
  for (int i = 0; i < 6; ++i) {
    scene.collider.find(i % 2 ? other : scene.poses, i % 2 ? scene.poses : other, 0.02);
  }
  EXPECT_EQ(allocationCount(), before);
}

}  // namespace
}  // namespace physics
