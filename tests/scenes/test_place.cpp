// A simulation that is told its frames instead of making them.
#include <gtest/gtest.h>

#include <limits>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

Simulation makeFall() {
  return Simulation(
      sceneOf("duration = 1\n[gravity]\nacceleration = [0, -10, 0]\n[[body]]\nname = "
              "\"p\"\nshape = { sphere = { radius = 1 } }\nmass = 2\n"));
}

TEST(Place, MakesTheNextFrameWhichEveryMeasureSees) {
  Simulation simulation = makeFall();
  auto poses = simulation.world().bodies().pose;
  auto velocities = simulation.world().bodies().velocity;
  poses[1].x = {0, -3, 0};
  velocities[1].v = {0, -4, 0};
  ASSERT_TRUE(simulation.place(poses, velocities));
  const FrameMetrics metrics = simulation.metrics();
  EXPECT_EQ(metrics.frame, 1);
  EXPECT_DOUBLE_EQ(metrics.kinetic, 16);
  EXPECT_DOUBLE_EQ(metrics.potential, -60);
  EXPECT_DOUBLE_EQ(metrics.maxSpeed, 4);
}

TEST(Place, KeepsTheFrameWhereANumberIsNotFinite) {
  Simulation simulation = makeFall();
  auto poses = simulation.world().bodies().pose;
  auto velocities = simulation.world().bodies().velocity;
  poses[1].x.y() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(simulation.place(poses, velocities));
  EXPECT_FALSE(simulation.isFinite());
  EXPECT_EQ(simulation.frame(), 0);
  EXPECT_EQ(simulation.world().bodies().pose[1].x.y(), 0);
}

}  // namespace
}  // namespace scenes
