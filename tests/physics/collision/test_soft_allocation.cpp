// Ropes, cloths and soft bodies step without allocating, once they have settled into their sizes.
#include <gtest/gtest.h>

#include "physics/world.h"
#include "tests/physics/collision/scene_of_two.h"
#include "tests/physics/sweeps.h"

namespace physics {
namespace {

using namespace testing;

Settings settings() {
  Settings s = sweeps();
  s.substeps = 2;
  s.iterations = 2;
  s.gravity = Vec3(0, -9.81, 0);
  s.contact.emplace();
  return s;
}

BodyId node(World& world, const Vec3& x, bool held = false) {
  BodyDef def;
  def.mass = 0.01;
  def.pose.x = x;
  if (held) def.motion = Motion::kStatic;
  return world.add(def);
}

void link(World& world, BodyId a, BodyId b) {
  LinkDef def;
  def.bodies = {a, b};
  world.add(def);
}

void ground(World& world) {
  BodyDef def;
  def.shape = Plane{};
  def.motion = Motion::kStatic;
  world.add(def);
}

long allocationsOf(World& world, int steps) {
  for (int k = 0; k < 20; ++k) world.step();
  const long before = allocationCount();
  for (int k = 0; k < steps; ++k) world.step();
  return allocationCount() - before;
}

TEST(SoftAllocation, NoneForARopeOfTwoHundredNodesOnTheGround) {
  World world(settings());
  ground(world);
  RopeLengthDef all;
  SoftSurfaceDef surface;
  for (int i = 0; i < 200; ++i) {
    all.bodies.push_back(node(world, Vec3(0.02 * i, 0.01, 0), i == 0));
    if (i == 0) continue;
    link(world, all.bodies[i - 1], all.bodies[i]);
    surface.links.push_back({all.bodies[i - 1], all.bodies[i]});
  }
  world.add(all);
  world.add(surface);
  EXPECT_EQ(allocationsOf(world, 5), 0);
  EXPECT_GT(world.contactCount(), 100);
}

TEST(SoftAllocation, NoneForAClothOfOneHundredByOneHundred) {
  World world(settings());
  constexpr int kSide = 100;
  std::vector<BodyId> nodes;
  for (int i = 0; i < kSide * kSide; ++i) {
    nodes.push_back(node(world, Vec3(0.01 * (i % kSide), 0, 0.01 * (i / kSide)), i < kSide));
  }
  SoftSurfaceDef surface;
  surface.nodes = nodes;
  world.add(surface);
  for (int i = 0; i < kSide * kSide; ++i) {
    if (i % kSide > 0) link(world, nodes[i - 1], nodes[i]);
    if (i >= kSide) link(world, nodes[i - kSide], nodes[i]);
  }
  EXPECT_EQ(allocationsOf(world, 3), 0);
}

// 1,000 cubes of 5 tetrahedra, neighbours mirrored so that their faces meet.
TEST(SoftAllocation, NoneForASoftBodyOfFiveThousandTetrahedra) {
  World world(settings());
  ground(world);
  constexpr int kCells = 10, kNodes = kCells + 1;
  const auto index = [](int x, int y, int z) { return (z * kNodes + y) * kNodes + x; };
  std::vector<BodyId> nodes;
  SoftSurfaceDef surface;
  for (int i = 0; i < kNodes * kNodes * kNodes; ++i) {
    const Vec3 cell(i % kNodes, i / kNodes % kNodes, i / (kNodes * kNodes));
    nodes.push_back(node(world, 0.05 * cell + Vec3(0, 0.012, 0)));
  }
  surface.nodes = nodes;
  world.add(surface);
  constexpr int kTets[5][4] = {
      {0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}};
  int count = 0;
  for (int c = 0; c < kCells * kCells * kCells; ++c) {
    const int x = c % kCells, y = c / kCells % kCells, z = c / (kCells * kCells);
    const int flip = (x + y + z) % 2;
    for (const auto& tet : kTets) {
      VolumeDef def;
      for (int k = 0; k < 4; ++k) {
        const int corner = flip != 0 ? tet[k] ^ 1 : tet[k];
        def.bodies[k] =
            nodes[index(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2 & 1))];
      }
      const auto at = [&](int k) { return world.bodies().pose[def.bodies[k]].x; };
      if (volumeOf({at(0), at(1), at(2), at(3)}) < 0) std::swap(def.bodies[0], def.bodies[1]);
      world.add(def);
      ++count;
    }
  }
  EXPECT_EQ(count, 5000);
  EXPECT_EQ(allocationsOf(world, 3), 0);
}

}  // namespace
}  // namespace physics
