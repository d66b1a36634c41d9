// A world that rests costs the same in every step, however long it has rested.
#include <gtest/gtest.h>
#include <malloc.h>

#include "physics/make/stack.h"
#include "physics/world.h"

namespace physics::testing {
namespace {

World restingPyramid() {
  Settings settings;
  settings.substeps = 1;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  PyramidDef pyramid;
  pyramid.base = 3;
  add(world, pyramid);
  return world;
}

struct Cost {
  std::size_t bytes = 0;  // on the heap, of the whole program
  std::int64_t evaluations = 0;
};

Cost costOf(World& world, int steps) {
  Cost cost;
  for (int k = 0; k < steps; ++k) cost.evaluations += world.step().constraintEvaluations;
  cost.bytes = mallinfo2().uordblks;
  return cost;
}

// 10^6 steps are a case of `dbd study stability`; what grew in them would grow here.
TEST(Endurance, ARestingPyramidNeedsNoMoreMemoryOrWorkAfterFortyThousandSteps) {
  World world = restingPyramid();
  costOf(world, 1000);
  const Cost early = costOf(world, 1000);
  costOf(world, 38000);
  const Cost late = costOf(world, 1000);
  EXPECT_EQ(late.bytes, early.bytes);
  EXPECT_LE(late.evaluations, early.evaluations);
}

}  // namespace
}  // namespace physics::testing
