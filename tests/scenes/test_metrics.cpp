// Metrics mean what their table says, and verdicts follow from them.
#include <gtest/gtest.h>

#include <set>

#include "scenes/measure/metrics.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

// A point that falls for one second from rest at y = 0, with this [[expect]].
Checker::Verdict verdictOnFall(const std::string& expectation) {
  const Scene scene = sceneOf(
      "duration = 1\n[gravity]\nacceleration = [0, -10, 0]\n[[body]]\nname = "
      "\"p\"\nshape = { sphere = { radius = 1 } }\nvelocity = [2, 0, 0]\n"
      "[[expect]]\n" +
      expectation);
  Simulation simulation(scene);
  Checker checker(scene);
  checker.observe(simulation);
  for (int i = 1; i < scene.frameCount(); ++i) {
    simulation.advance();
    checker.observe(simulation);
  }
  return checker.verdicts().at(0);
}

TEST(Metric, DriftIsTheHorizontalDistanceFromTheStart) {
  EXPECT_NEAR(verdictOnFall("metric = \"drift\"\nbody = \"p\"\nat_most = 3\n").value, 2, 1e-9);
}

TEST(Metric, DropIsTheWayDown) {
  // first order in the substep of 1/240 s
  EXPECT_NEAR(verdictOnFall("metric = \"drop\"\nbody = \"p\"\nat_most = 9\n").value, 5, 0.03);
}

TEST(Metric, HeightIsLeastForAtLeast) {
  const auto verdict = verdictOnFall("metric = \"height\"\nbody = \"p\"\nat_least = -1\n");
  EXPECT_FALSE(verdict.holds);
  EXPECT_NEAR(verdict.value, -5, 0.03);
  EXPECT_NEAR(verdict.atTime, 1, 1e-9);
}

TEST(Metric, LooksOnlyAtItsSpan) {
  EXPECT_TRUE(verdictOnFall("metric = \"height\"\nbody = \"p\"\nat_least = -1\nto = 0.4\n").holds);
}

TEST(Metric, FiniteNeedsNoBound) { EXPECT_TRUE(verdictOnFall("metric = \"finite\"\n").holds); }

TEST(Metric, FiniteIsTheEnergyToo) {
  const Scene scene = sceneOf(
      "duration = 1\n[[body]]\nname = \"p\"\nshape = { sphere = { radius = 1 } }\n"
      "velocity = [1e160, 0, 0]\n[[expect]]\nmetric = \"finite\"\n");
  const Simulation simulation(scene);
  Checker checker(scene);
  checker.observe(simulation);
  EXPECT_FALSE(checker.verdicts().at(0).holds);
}

TEST(Metric, TellsValueAndBoundInItsText) {
  EXPECT_EQ(verdictOnFall("metric = \"drift\"\nbody = \"p\"\nat_most = 3\n").text,
            "drift of p 2 m <= 3 m");
  EXPECT_EQ(verdictOnFall("metric = \"drift\"\nbody = \"p\"\nat_most = 1\n").text,
            "drift of p 2 m, expected <= 1 m");
}

// A bound on one side must not hide what is on the other.
TEST(Metric, AnEnergyIsToldFromItsLossToItsGain) {
  const std::string fall = "metric = \"energy_drift\"\n";
  const std::string drag = "[[drag]]\nbody = \"p\"\ncoefficient = 100\n";
  const auto verdict = verdictOnFall(fall + "at_most = 0.001\n" + drag);
  EXPECT_TRUE(verdict.holds);
  EXPECT_LT(verdict.least, -0.01);
  EXPECT_EQ(verdict.most, 0);
  EXPECT_TRUE(verdict.text.starts_with("energy_drift -")) << verdict.text;
  EXPECT_TRUE(verdict.text.ends_with(" ... 0 <= 0.1 % (no gain; it says nothing of a loss)"))
      << verdict.text;
  const auto least = verdictOnFall(fall + "at_least = -0.5\n" + drag);
  EXPECT_TRUE(least.text.ends_with(" ... 0 >= -50 % (no further loss; it says nothing of a gain)"))
      << least.text;
  const auto both = verdictOnFall(fall + "at_most = 0.001\nat_least = -0.5\n" + drag);
  EXPECT_TRUE(both.text.ends_with(" ... 0 >= -50 % and <= 0.1 %")) << both.text;
  const auto joule = verdictOnFall("metric = \"energy_gain\"\nat_most = 1\n" + drag);
  EXPECT_TRUE(joule.text.ends_with(" ... 0 J <= 1 J (no gain; it says nothing of a loss)"))
      << joule.text;
}

TEST(Metric, TiltOfABodyThatTurnsAboutZIsItsAngle) {
  const Scene scene = sceneOf(
      "duration = 0.5\n[simulation]\nmethod = \"nonlinear_gauss_seidel\"\n"
      "[[body]]\nname = \"p\"\nshape = { sphere = { radius = 1 "
      "} }\nangular_velocity = [0, 0, 1]\n[[expect]]\nmetric = \"tilt\"\nbody = "
      "\"p\"\nat_most = 1\n");
  Simulation simulation(scene);
  Checker checker(scene);
  for (int i = 0; i < scene.frameCount(); ++i) {
    checker.observe(simulation);
    simulation.advance();
  }
  EXPECT_NEAR(checker.verdicts()[0].value, 0.5 * 180 / M_PI, 1e-9);
}

TEST(Metric, EnergyRiseIsThatOfAFrame) {
  const Scene scene = sceneOf(
      "duration = 0.1\n[[body]]\nname = \"p\"\nshape = { sphere = { radius = 1 } }\nmass = 2\n"
      "velocity = [3, 0, 0]\n[[force]]\nbody = \"p\"\nforce = [120, 0, 0]\n"
      "[[expect]]\nmetric = \"energy_rise\"\nat_most = 1\nfrom = 0.1\n");
  Simulation simulation(scene);
  Checker checker(scene);
  std::vector<double> energy;
  for (int i = 0; i < scene.frameCount(); ++i) {
    checker.observe(simulation);
    energy.push_back(simulation.metrics().total);
    simulation.advance();
  }
  EXPECT_NEAR(energy[0], 9, 1e-12);
  EXPECT_NEAR(checker.verdicts()[0].value, (energy[6] - energy[5]) / energy[6], 1e-12);
  EXPECT_GT(energy[6], energy[5]);
}

// Three rods that turn about z: the second is over first.
TEST(Metric, OutOfTurnCountsWhatFellBeforeAnEarlierOne) {
  std::string text = "duration = 1\n";
  for (const char* speed : {"0.5", "1.5", "0.1"}) {
    text += "[[body]]\nshape = { sphere = { radius = 1 } }\nname = \"r" + std::string(speed) +
            "\"\nangular_velocity = [0, 0, " + speed + "]\n";
  }
  text += "[[expect]]\nmetric = \"out_of_turn\"\nbody = \"r*\"\nat_most = 0\n";
  const Scene scene = sceneOf(text);
  Simulation simulation(scene);
  Checker checker(scene);
  for (int i = 0; i < scene.frameCount(); ++i) {
    checker.observe(simulation);
    simulation.advance();
  }
  EXPECT_EQ(checker.verdicts()[0].value, 1);
  EXPECT_NEAR(checker.verdicts()[0].atTime, M_PI / 4 / 1.5, 1.0 / 60);
}

TEST(Metric, NamesAreUnique) {
  const std::vector<std::string> names = metricNames();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Pattern, MatchesWithStars) {
  EXPECT_TRUE(matches("stack.*", "stack.12"));
  EXPECT_TRUE(matches("*.head", "doll.3.head"));
  EXPECT_TRUE(matches("*", "anything"));
  EXPECT_FALSE(matches("stack.*", "stick.1"));
  EXPECT_FALSE(matches("stack", "stack.1"));
}

}  // namespace
}  // namespace scenes
