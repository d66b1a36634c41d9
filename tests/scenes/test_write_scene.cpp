// The text that a record keeps gives the same scene again.
#include <gtest/gtest.h>

#include "scenes/read/write_scene.h"
#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

Scene again(const Scene& scene) { return parseScene(textOf(scene), scene.path); }

class WrittenScene : public testing::TestWithParam<std::string> {};

TEST_P(WrittenScene, IsTheSameSceneAndTheSameText) {
  const Scene scene = readScene(GetParam());
  const Scene second = again(scene);
  EXPECT_EQ(textOf(second), textOf(scene));
  EXPECT_EQ(Simulation(second).stateHash(), Simulation(scene).stateHash());
  EXPECT_EQ(second.frameCount(), scene.frameCount());
}

INSTANTIATE_TEST_SUITE_P(Library, WrittenScene, testing::ValuesIn(libraryScenes()),
                         [](const auto& info) { return info.param; });

TEST(WriteScene, WritesOutWhatIsRepeatedAndComputed) {
  const Scene scene = sceneOf(
      "title = \"Balls of \\\"{r}\\\" m\"\n[parameters]\nr = 0.25\n[[repeat]]\ncount = 2\n"
      "[[repeat.body]]\nname = \"ball {i}\"\nposition = [\"= 2 * i\", 0, 1e-9]\n"
      "shape = { sphere = { radius = \"= r\" } }\n");
  EXPECT_EQ(textOf(scene),
            "title = \"Balls of \\\"0.25\\\" m\"\n"
            "\n[[body]]\nname = \"ball 0\"\nposition = [0, 0, 1e-09]\n"
            "shape = { sphere = { radius = 0.25 } }\n"
            "\n[[body]]\nname = \"ball 1\"\nposition = [2, 0, 1e-09]\n"
            "shape = { sphere = { radius = 0.25 } }\n");
}

TEST(WriteScene, WritesOverridesInAndLeavesOutWhatTheyCutOff) {
  const std::string text = "duration = 4\n" + ball("a") +
                           "[golden]\nframes = [200]\n"
                           "[[expect]]\nmetric = \"finite\"\nfrom = 3\n";
  const Scene scene = sceneOf(text, {"duration=1", "body.a.color=orange"});
  const std::string written = textOf(scene);
  EXPECT_NE(written.find("duration = 1\n"), std::string::npos) << written;
  EXPECT_NE(written.find("color = \"orange\"\n"), std::string::npos) << written;
  EXPECT_EQ(written.find("expect"), std::string::npos) << written;
  EXPECT_EQ(again(scene).frameCount(), 61);
}

}  // namespace
}  // namespace scenes
