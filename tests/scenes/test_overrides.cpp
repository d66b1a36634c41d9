// --set: any value by its dotted key, typed and checked as the file is.
#include <gtest/gtest.h>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

TEST(Override, ReplacesAValueOfATable) {
  EXPECT_EQ(
      sceneOf("[simulation]\niterations = 1\n", {"simulation.iterations=32"}).settings.iterations,
      32);
}

TEST(Override, CreatesATableThatTheFileLacks) {
  const Scene scene = sceneOf("", {"gravity.acceleration=[0, -1, 0]"});
  EXPECT_EQ(*scene.settings.gravity, physics::Vec3(0, -1, 0));
}

TEST(Override, AddressesABodyByName) {
  const Scene scene = sceneOf(ball("a") + ball("b"), {"body.b.mass=3"});
  EXPECT_EQ(Simulation(scene).world().bodies().mass[2], 3);
}

TEST(Override, AddressesAnElementByIndex) {
  const Scene scene = sceneOf("[[stack]]\ncount = 2\n", {"stack.0.count=5"});
  EXPECT_EQ(Simulation(scene).world().bodyCount(), 6);
}

TEST(Override, AddressesANumberOfAVector) {
  const Scene scene = sceneOf(ball("a") + "position = [1, 2, 3]\n", {"body.a.position.1=7"});
  EXPECT_EQ(Simulation(scene).world().bodies().pose[1].x, physics::Vec3(1, 7, 3));
}

TEST(Override, TakesABareWordForAString) {
  EXPECT_EQ(sceneOf("", {"simulation.method=direct"}).settings.method, physics::Method::kDirect);
}

TEST(Override, MayShortenASceneBelowItsGoldenFrames) {
  EXPECT_EQ(errorOf("duration = 9\n[golden]\nframes = [500]\n", {"duration=1"}), "no error");
}

TEST(Override, ThatIsOutOfRangeIsCited) {
  EXPECT_EQ(errorOf("", {"simulation.fps=0"}),
            "--set simulation.fps=0: simulation.fps: expected an integer in [1, 1000000], got 0");
}

TEST(Override, OfAnUnknownKeyIsCited) {
  EXPECT_EQ(errorOf("", {"simulation.fsp=30"}),
            "--set simulation.fsp=30: simulation: unknown key 'fsp'; did you mean 'fps'?");
}

TEST(Override, OfABodyThatIsNotThereNamesTheNearest) {
  EXPECT_EQ(errorOf(ball("plank"), {"body.plonk.mass=1"}),
            "--set body.plonk.mass=1: no body 'plonk'; did you mean 'plank'?");
}

TEST(Override, OfAnIndexPastTheEndIsCited) {
  EXPECT_EQ(errorOf(ball("a"), {"body.3.mass=1"}),
            "--set body.3.mass=1: body: expected an index below 1, got 3");
}

TEST(Override, WithoutAnEqualsSignIsCited) {
  EXPECT_EQ(errorOf("", {"simulation.fps"}), "--set simulation.fps: expected key=value");
}

TEST(Override, WithoutAValueIsCited) {
  EXPECT_EQ(errorOf("", {"simulation.fps="}),
            "--set simulation.fps=: expected a TOML value after '=', got nothing");
}

TEST(Override, IntoANumberIsCited) {
  EXPECT_EQ(errorOf("duration = 3\n", {"duration.x=1"}),
            "--set duration.x=1: duration: expected a table, got 3");
}

}  // namespace
}  // namespace scenes
