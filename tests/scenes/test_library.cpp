// Every scene of the library can be read, and says what it claims.
#include <gtest/gtest.h>

#include "scenes/simulation.h"

namespace scenes {
namespace {

class Library : public testing::TestWithParam<std::string> {};

TEST_P(Library, SceneReads) { EXPECT_NO_THROW(readScene(GetParam())); }

TEST_P(Library, SceneHasTitleDescriptionExpectationsAndGoldenFrames) {
  const Scene scene = readScene(GetParam());
  EXPECT_NE(scene.title, scene.name);
  EXPECT_FALSE(scene.description.empty());
  EXPECT_FALSE(scene.expectations.empty());
  EXPECT_FALSE(scene.golden.frames.empty());
}

TEST_P(Library, SceneStartsWithoutOverlap) {
  const Simulation simulation(readScene(GetParam()));
  EXPECT_LT(simulation.world().largestOverlap(), 1e-6);
}

TEST_P(Library, SceneStartsWithItsJointsClosed) {
  const Simulation simulation(readScene(GetParam()));
  for (const physics::KindError& error : simulation.world().constraintErrors()) {
    if (error.unit == "m" && error.kind != "contact") {
      EXPECT_LT(error.largest, 1e-8) << error.kind;
    }
  }
}

TEST_P(Library, SceneStartsWithinItsLimits) {
  const Simulation simulation(readScene(GetParam()));
  for (const physics::KindError& error : simulation.world().constraintErrors()) {
    const double allowed = error.unit == "rad" ? 1e-6 : std::numeric_limits<double>::infinity();
    EXPECT_LE(error.largest, allowed) << error.kind;
  }
}

INSTANTIATE_TEST_SUITE_P(AllScenes, Library, testing::ValuesIn(libraryScenes()),
                         [](const auto& scene) { return scene.param; });

TEST(Scene, SwitchesContactsOnForAPlane) {
  const Scene scene = parseScene("[[body]]\nshape = { plane = {} }\n", "test.toml");
  EXPECT_TRUE(scene.settings.contact.has_value());
}

TEST(Scene, SwitchesContactsOnForABodyWithFriction) {
  const Scene scene =
      parseScene("[[body]]\nshape = { sphere = { radius = 1 } }\nfriction = 1\n", "test.toml");
  EXPECT_TRUE(scene.settings.contact.has_value());
}

TEST(Scene, LeavesContactsOffOtherwise) {
  const Scene scene = parseScene("[[body]]\nshape = { sphere = { radius = 1 } }\n", "test.toml");
  EXPECT_FALSE(scene.settings.contact.has_value());
}

TEST(Scene, SwitchesContactsOffWhereAsked) {
  const Scene scene =
      parseScene("[contact]\nenabled = false\n[[body]]\nshape = { plane = {} }\n", "test.toml");
  EXPECT_FALSE(scene.settings.contact.has_value());
}

}  // namespace
}  // namespace scenes
