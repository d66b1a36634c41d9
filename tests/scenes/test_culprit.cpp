// Where and when an expectation fails first.
#include <gtest/gtest.h>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

const std::string kSphere = "shape = { sphere = { radius = 0.5 } }\nmass = 1\n";

Checker::Verdict verdictOf(const std::string& text) {
  const Scene scene = sceneOf(text);
  Simulation simulation(scene);
  Checker checker(scene);
  checker.observe(simulation);
  while (simulation.frame() + 1 < scene.frameCount()) {
    simulation.advance();
    checker.observe(simulation);
  }
  EXPECT_EQ(checker.hasFailed(), checker.verdicts().at(0).failure.has_value());
  return checker.verdicts().at(0);
}

void expectFailsAtOnce(const std::string& text, const std::string& constraint,
                       const std::string& bodies) {
  const auto verdict = verdictOf(text);
  ASSERT_TRUE(verdict.failure);
  EXPECT_EQ(verdict.failure->frame, 0);
  EXPECT_EQ(verdict.failure->constraint, constraint);
  EXPECT_EQ(verdict.failure->bodies, bodies);
}

// x = t.
std::string flight(const std::string& bound) {
  return "duration = 1\n[simulation]\nfps = 10\n[[body]]\nname = \"p\"\nvelocity = [1, 0, 0]\n" +
         kSphere + "[[expect]]\nmetric = \"x\"\nbody = \"p\"\n" + bound;
}

TEST(Culprit, OfABodysMetricIsTheBodyInTheFirstFrameThatFails) {
  const auto verdict = verdictOf(flight("at_most = 0.55\n"));
  ASSERT_TRUE(verdict.failure);
  EXPECT_EQ(verdict.failure->frame, 6);
  EXPECT_NEAR(verdict.failure->value, 0.6, 1e-9);
  EXPECT_EQ(verdict.failure->bodies, "p");
}

TEST(Culprit, IsNobodyWhereTheExpectationHolds) {
  EXPECT_FALSE(verdictOf(flight("at_most = 1.5\n")).failure);
  EXPECT_FALSE(verdictOf(flight("from = 0.45\nat_least = 0.45\n")).failure);
}

TEST(Culprit, IsLookedForInTheSpanOnly) {
  const auto verdict = verdictOf(flight("from = 0.75\nat_most = 0.25\n"));
  ASSERT_TRUE(verdict.failure);
  EXPECT_EQ(verdict.failure->frame, 8);
}

TEST(Culprit, OfAJointErrorIsTheWidestJoint) {
  expectFailsAtOnce(
      "duration = 0.1\n[simulation]\nfps = 10\n[[body]]\nname = \"a\"\nposition = [0, 0, 0]\n" +
          kSphere + "[[body]]\nname = \"b\"\nposition = [3, 0, 0]\n" + kSphere +
          "[[distance]]\nbodies = [\"world\", \"a\"]\nanchors = [[0, 1, 0], [0, 0, 0]]\nlength = "
          "1\n"
          "[[distance]]\nbodies = [\"a\", \"b\"]\nanchors = [[0, 0, 0], [0, 0, 0]]\nlength = 1\n"
          "[[expect]]\nmetric = \"joint_error\"\nat_most = 0.1\n",
      "distance 1", "a, b");
}

TEST(Culprit, OfAVolumeErrorIsTheWorstTetrahedron) {
  expectFailsAtOnce(
      "duration = 0.1\n[simulation]\nfps = 10\n[[soft_body]]\nname = \"tet\"\n"
      "mesh = \"tetrahedron.mesh\"\nstart_scale = [1, 0.3, 1]\ndensity = 1000\n"
      "[[expect]]\nmetric = \"volume_error\"\nat_most = 0.1\n",
      "volume 0", "tet.0, tet.1, tet.2, tet.3");
}

TEST(Culprit, OfAnOverlapIsTheDeepestContact) {
  const auto verdict =
      verdictOf("duration = 0.1\n[contact]\nfriction = 0.5\n[[body]]\nname = \"a\"\n" + kSphere +
                "[[body]]\nname = \"b\"\nposition = [0.9, 0, 0]\n" + kSphere +
                "[[body]]\nname = \"c\"\nposition = [1.5, 0, 0]\n" + kSphere +
                "[[expect]]\nmetric = \"overlap\"\nat_most = 0.01\n");
  ASSERT_TRUE(verdict.failure);
  EXPECT_EQ(verdict.failure->constraint, "contact");
  EXPECT_EQ(verdict.failure->bodies, "b, c");
}

TEST(Culprit, OfASpeedIsTheFastestBody) {
  const auto verdict =
      verdictOf("duration = 0.1\n[[body]]\nname = \"a\"\nvelocity = [1, 0, 0]\n" + kSphere +
                "[[body]]\nname = \"b\"\nposition = [9, 0, 0]\nvelocity = [0, 5, 0]\n" + kSphere +
                "[[expect]]\nmetric = \"max_speed\"\nat_most = 2\n");
  ASSERT_TRUE(verdict.failure);
  EXPECT_EQ(verdict.failure->bodies, "b");
}

}  // namespace
}  // namespace scenes
