// The words for what a step leaves alone: [sleep], local substeps.
#include <gtest/gtest.h>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

TEST(LeftOut, NothingSleepsWithoutTheTable) {
  const Scene scene = parseScene("title = \"a\"\n", "test.toml");
  EXPECT_FALSE(scene.settings.sleep);
  EXPECT_FALSE(scene.settings.localSubsteps);
  EXPECT_TRUE(scene.settings.leavesOut);
}

TEST(LeftOut, TheWordsAreRead) {
  const Scene scene = parseScene(
      "[sleep]\nspeed = 0.01\ntime = 2\n"
      "[simulation]\nlocal_substeps = true\nlocal_tolerance = 1e-3\nleave_out = false\n",
      "test.toml");
  ASSERT_TRUE(scene.settings.sleep);
  EXPECT_EQ(scene.settings.sleep->speed, 0.01);
  EXPECT_EQ(scene.settings.sleep->time, 2);
  EXPECT_TRUE(scene.settings.localSubsteps);
  EXPECT_EQ(scene.settings.localTolerance, 1e-3);
  EXPECT_FALSE(scene.settings.leavesOut);
  EXPECT_EQ(scene.effects, std::vector<std::string>{"sleep"});
}

TEST(LeftOut, SleepCanBeSwitchedOffByAnOverride) {
  const std::vector<std::string> off = {"sleep.enabled=false"};
  EXPECT_FALSE(parseScene("[sleep]\n", "test.toml", off).settings.sleep);
}

TEST(LeftOut, WrongValuesAreReportedAtTheirPlace) {
  EXPECT_EQ(errorOf("[sleep]\nspeed = -1\n"),
            "test.toml:2:9: sleep.speed: expected a number >= 0, got -1");
  EXPECT_EQ(errorOf("[sleep]\ntime = 0\n"),
            "test.toml:2:8: sleep.time: expected a number > 0, got 0");
  EXPECT_EQ(errorOf("[sleep]\ntimes = 1\n"),
            "test.toml:2:1: sleep: unknown key 'times'; did you mean 'time'?");
  EXPECT_EQ(errorOf("[simulation]\nlocal_tolerance = 0\n"),
            "test.toml:2:19: simulation.local_tolerance: expected a number > 0 [m], got 0");
}

TEST(LeftOut, MetricsCountTheBodiesThatSleep) {
  Simulation run(parseScene(
      "[simulation]\nmethod = \"nonlinear_gauss_seidel\"\n[gravity]\n[sleep]\ntime = 0.1\n"
      "[[body]]\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n"
      "[[body]]\nname = \"box\"\nshape = { box = { size = [1, 1, 1] } }\n"
      "mass = 1\nposition = [0, 0.5, 0]\n",
      "test.toml"));
  EXPECT_EQ(run.metrics().asleep, 0);
  for (int k = 0; k < 20; ++k) run.advance();
  EXPECT_EQ(run.metrics().asleep, 1);
}

TEST(LeftOut, ABodyAsksForSubstepsOfItsOwn) {
  const Scene scene = parseScene(
      "[simulation]\nmethod = \"nonlinear_gauss_seidel\"\nsubsteps = 8\nlocal_substeps = true\n"
      "[[body]]\nname = \"a\"\nshape = { sphere = { radius = 1 } }\n"
      "mass = 1\nsubsteps = 4\n",
      "test.toml");
  Simulation run(scene);
  for (int k = 0; k < 60; ++k) run.advance();
  EXPECT_EQ(run.world().substepsOf(run.findBody("a")), 4);
}

}  // namespace
}  // namespace scenes
