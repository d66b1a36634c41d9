// What is wrong with keys, types and ranges is reported at its place in the file.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

std::string repeated(const std::string& piece, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += piece;
  return text;
}

TEST(SceneText, RefusesKeysOfTooManyParts) {
  const std::string refusal = "expected a key of at most 16 parts";
  EXPECT_EQ(errorOf("title = \"a\"\n" + repeated("a.", 100000) + "b = 1\n"),
            "test.toml:2:32: " + refusal);
  EXPECT_EQ(errorOf(std::string("[").append(repeated("a.", 100000)).append("b]\n")),
            "test.toml:1:33: " + refusal);
  EXPECT_EQ(errorOf("x = { " + repeated("\"a\" . ", 20) + "b = 1 }\n"),
            "test.toml:1:101: " + refusal);
}

TEST(SceneText, DotsInStringsAndCommentsAndNumbersAreNoKeys) {
  const std::string dots = repeated("a.b ", 50);
  EXPECT_EQ(errorOf("title = \"" + dots + "\\\" \" # " + dots + "\ndescription = \"\"\"\n" + dots +
                    "\"\"\"\n[camera]\ndirection = [1.0, 2.0, 3.0]\n"),
            "no error");
}

TEST(SceneFile, ThatIsNotTomlIsReportedWhereItStopsToBe) {
  EXPECT_TRUE(
      errorOf("title = \"a\"\nduration = = 3\n").starts_with("test.toml:2:12: expected TOML:"));
  for (const char* header : {"[[=]]", "[[[a]]]", "[[", "[ = ]"}) {
    const std::string error = errorOf(std::string("title = \"a\"\n") + header + "\n");
    EXPECT_TRUE(error.starts_with("test.toml:2:")) << header << ": " << error;
  }
}

TEST(SceneFile, NamesTheNearestKeyForAnUnknownOne) {
  EXPECT_EQ(errorOf("[simulation]\n  subseps = 4\n"),
            "test.toml:2:3: simulation: unknown key 'subseps'; did you mean 'substeps'?");
}

TEST(SceneFile, NamesTheNearestTableForAnUnknownOne) {
  EXPECT_EQ(errorOf("[[bdoy]]\nname = \"a\"\n"),
            "test.toml:1:3: unknown table 'bdoy'; did you mean 'body'?");
}

TEST(SceneFile, NamesAllKeysForOneThatIsNearNone) {
  EXPECT_EQ(errorOf("[light]\nzzzzzzzzzz = 1\n"),
            "test.toml:2:1: light: unknown key 'zzzzzzzzzz'; expected shadows, direction, softness "
            "or color");
  EXPECT_EQ(errorOf("[gravity]\nzzzzzzzzzz = 1\n"),
            "test.toml:2:1: gravity: unknown key 'zzzzzzzzzz'; expected acceleration");
  EXPECT_EQ(errorOf("[sleep]\nzzzzzzzzzz = 1\n"),
            "test.toml:2:1: sleep: unknown key 'zzzzzzzzzz'; expected enabled, speed or time");
  const std::string table = errorOf("zzzzzzzzzz = 1\n");
  EXPECT_TRUE(table.starts_with("test.toml:1:1: unknown key 'zzzzzzzzzz'; expected title, "))
      << table;
}

TEST(SceneFile, WantsArraysOfTablesForWordsThatMayRepeat) {
  EXPECT_EQ(errorOf("[body]\nname = \"a\"\n"),
            "test.toml:1:1: body: expected tables [[body]], got a table");
}

TEST(SceneFile, RefusesFramesPerSecondOfZero) {
  EXPECT_EQ(errorOf("[simulation]\nfps = 0\n"),
            "test.toml:2:7: simulation.fps: expected an integer in [1, 1000000], got 0");
}

TEST(SceneFile, RefusesNegativeFramesPerSecond) {
  EXPECT_EQ(errorOf("[simulation]\nfps = -60\n"),
            "test.toml:2:7: simulation.fps: expected an integer in [1, 1000000], got -60");
}

TEST(SceneFile, RefusesHalfASubstep) {
  EXPECT_EQ(errorOf("[simulation]\nsubsteps = 1.5\n"),
            "test.toml:2:12: simulation.substeps: expected an integer in [1, 1000000], got 1.5");
}

TEST(SceneFile, RefusesADurationOfZero) {
  EXPECT_EQ(errorOf("duration = 0\n"), "test.toml:1:12: duration: expected a number > 0, got 0");
}

TEST(SceneFile, ListsTheMethodsForAnUnknownOne) {
  EXPECT_EQ(
      errorOf("[simulation]\nmethod = \"magic\"\n"),
      "test.toml:2:10: simulation.method: expected one of 'nonlinear_gauss_seidel', 'direct', "
      "'linear_gauss_seidel', 'xpbd', 'sequential_impulses', 'penalty', 'penalty_explicit', "
      "'small_steps', got 'magic'");
}

TEST(SceneFile, RefusesGravityThatIsNotAVector) {
  EXPECT_EQ(errorOf("[gravity]\nacceleration = -9.81\n"),
            "test.toml:2:16: gravity.acceleration: expected [x, y, z], got -9.81");
}

TEST(SceneFile, RefusesInfiniteGravity) {
  EXPECT_EQ(errorOf("[gravity]\nacceleration = [0, -inf, 0]\n"),
            "test.toml:2:20: gravity.acceleration: expected a finite number, got -inf");
}

TEST(SceneFile, RefusesDynamicFrictionAboveStaticFriction) {
  EXPECT_EQ(errorOf("[contact]\nfriction = { static = 0.2, dynamic = 0.5 }\n"),
            "test.toml:2:38: contact.friction.dynamic: expected a number <= static = 0.2, got 0.5");
}

TEST(SceneFile, RefusesCameraKeysOutOfOrder) {
  EXPECT_EQ(errorOf("[camera]\nkeys = [\n"
                    "  { time = 2, eye = [1, 1, 1], target = [0, 0, 0] },\n"
                    "  { time = 1, eye = [1, 1, 1], target = [0, 0, 0] },\n]\n"),
            "test.toml:4:3: camera.keys: expected times that increase, got 1 after 2");
}

TEST(SceneFile, NamesTheNearestMetricForAnUnknownOne) {
  EXPECT_EQ(errorOf("[[expect]]\nmetric = \"join_error\"\nat_most = 1\n"),
            "test.toml:2:10: expect.metric: unknown metric 'join_error'; did you mean "
            "'joint_error'?");
}

TEST(SceneFile, WantsABoundForAnExpectation) {
  EXPECT_EQ(errorOf("[[expect]]\nmetric = \"overlap\"\n"),
            "test.toml:1:1: expect: expected 'at_most' or 'at_least'");
}

TEST(SceneFile, WantsABodyForABodysMetric) {
  EXPECT_EQ(errorOf("[[expect]]\nmetric = \"height\"\nat_most = 1\n"),
            "test.toml:2:10: expect.metric: expected a 'body' as well: height is y of a body's "
            "centre of mass");
}

TEST(SceneFile, RefusesGoldenFramesAfterTheEnd) {
  EXPECT_EQ(errorOf("duration = 1\n[golden]\nframes = [0, 61]\n"),
            "test.toml:3:10: golden.frames: expected frames below 61, got 61");
}

TEST(SceneFile, TakesIntegersForNumbers) { EXPECT_EQ(sceneOf("duration = 3\n").duration, 3.0); }

}  // namespace
}  // namespace scenes
