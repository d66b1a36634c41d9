// Threads: everything they share is done once, and nothing that comes out depends on them.
#include "physics/base/workers.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "physics/world.h"
#include "physics/world/measure.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

TEST(Workers, DoEveryItemOnce) {
  Workers workers;
  workers.setCount(3);
  for (int round = 0; round < 2000; ++round) {
    std::vector<int> done(round);
    workers.forEachChunk(round, 5, [&](int from, int to) {
      for (int i = from; i < to; ++i) ++done[i];
    });
    ASSERT_EQ(done, std::vector<int>(round, 1));
  }
}

TEST(Workers, AreOneAtLeast) {
  Workers workers;
  EXPECT_THROW(workers.setCount(0), std::invalid_argument);
}

// Boxes close to each other, with pairs that a joint holds: few, and enough for their contacts to
// be dealt by parts.
struct Heap {
  int layers, steps;
  std::size_t leastPoints;
};
constexpr Heap kFew = {6, 100, 0};
constexpr Heap kMany = {36, 20, std::size_t{4} * 8192};  // contacts of four points, in four parts

std::uint64_t hashOf(const Heap& heap, int threads, bool jointed) {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  World world(settings);
  world.setThreads(threads);
  addGround(world);
  BodyId last = kWorldBody;
  for (int k = 0; k < 10 * 10 * heap.layers; ++k) {
    const Vec3 x(1.01 * (k % 10) + 0.003 * (k % 7), 0.5 + 1.01 * (k / 100), 1.01 * (k / 10 % 10));
    const BodyId body = addBody(world, Box{Vec3(1, 0.9 + 0.02 * (k % 5), 1)}, x, 1 + k % 3);
    if (jointed && k % 10 % 2 == 1) {
      BallSocketDef joint;
      joint.bodies = {last, body};
      joint.at = x - Vec3(0.5, 0, 0);
      world.add(joint);
    }
    last = body;
  }
  run(world, heap.steps);
  EXPECT_GE(world.contacts().size(), heap.leastPoints);
  return stateHash(world);
}

class Threads : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Jointed, Threads, ::testing::Bool());

TEST_P(Threads, GiveTheSameBytesWhateverTheirNumber) {
  for (const Heap& heap : {kFew, kMany}) {
    const std::uint64_t one = hashOf(heap, 1, GetParam());
    EXPECT_EQ(hashOf(heap, 2, GetParam()), one);
    EXPECT_EQ(hashOf(heap, 3, GetParam()), one);
  }
}

}  // namespace
}  // namespace physics::testing
