// Arms in scene files: their links, angles, targets and errors.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

using physics::Vec3;

const std::string kArm = "[[arm]]\nat = [0, 0, 0]\ncount = 6\nlength = 0.2\nhinge = [0, 0, 1]\n";

physics::ArmReport armOf(const Simulation& simulation) { return simulation.world().arms().at(0); }

physics::ArmReport armAfter(const std::string& text, int frames) {
  Simulation simulation(sceneOf(text));
  for (int i = 0; i < frames; ++i) simulation.advance();
  return armOf(simulation);
}

TEST(ArmWord, NamesItsLinksByIndexAndTheLastItsEnd) {
  const Simulation simulation(sceneOf(kArm));
  EXPECT_EQ(simulation.bodyName(1), "arm.0");
  EXPECT_EQ(simulation.findBody("arm.5"), 6);
  EXPECT_EQ(simulation.findBody("arm.end"), 6);
  EXPECT_NEAR(armOf(simulation).tip.x(), 1.2, 1e-12);
}

TEST(ArmWord, OneAngleBendsEveryJointAndAbsoluteAnglesCountFromTheBase) {
  const Vec3 tip = armAfter(kArm + "angles_degrees = 10\n", 0).tip;
  Vec3 expected = Vec3::Zero();
  for (int k = 1; k <= 6; ++k) {
    expected += 0.2 * Vec3(std::cos(k * M_PI / 18), std::sin(k * M_PI / 18), 0);
  }
  EXPECT_LT((tip - expected).norm(), 1e-12);
  const std::string absolute = "absolute_degrees = [10, 20, 30, 40, 50, 60]\n";
  EXPECT_LT((armAfter(kArm + absolute, 0).tip - expected).norm(), 1e-12);
}

TEST(ArmWord, TakesEachLinkFromItsOwnTable) {
  const physics::ArmReport arm = armAfter(
      "[[arm]]\nat = [0, 1, 0]\ndirection = [0, 1, 0]\nmass = 2\n"
      "links = [{ length = 0.5 }, { length = 0.25, mass = 3, hinge = [1, 0, 0] }]\n",
      0);
  EXPECT_LT((arm.tip - Vec3(0, 1.75, 0)).norm(), 1e-12);
  EXPECT_LT((arm.centres[1] - Vec3(0, 1.625, 0)).norm(), 1e-12);
}

TEST(ArmWord, GoesSmoothlyFromTargetToTargetAndJumpsWhereAsked) {
  const std::string keys =
      "targets = [{ time = 0, at = [1, 0, 0] }, { time = 1, at = [0.8, 0.4, 0] }, "
      "{ time = 2, at = [0.2, 0.6, 0], jump = true }]\n";
  EXPECT_LT((armAfter(kArm + keys, 30).target - Vec3(0.9, 0.2, 0)).norm(), 1e-12);
  EXPECT_LT((armAfter(kArm + keys, 119).target - Vec3(0.8, 0.4, 0)).norm(), 1e-12);
  EXPECT_LT((armAfter(kArm + keys, 120).target - Vec3(0.2, 0.6, 0)).norm(), 1e-12);
}

TEST(ArmWord, FollowsABody) {
  const physics::ArmReport arm =
      armAfter("[contact]\nenabled = false\n" + kArm +
                   "angles_degrees = 10\nfollow = \"b\"\n"
                   "[[body]]\nname = \"b\"\nshape = { sphere = { radius = 0.1 } }\n"
                   "position = [0.5, 0.7, 0]\nvelocity = [0.3, 0, 0]\n",
               60);
  EXPECT_LT((arm.target - Vec3(0.8, 0.7, 0)).norm(), 1e-9);
  EXPECT_LT(arm.error, 1e-3);  // of 5 mm a frame; measured 1.8e-4
}

TEST(ArmWord, IsAnErrorWithItsPlaceWhereItMakesNoSense) {
  EXPECT_EQ(errorOf("[[arm]]\nat = [0, 0, 0]\ncount = 3\nlength = 0\n"),
            "test.toml:4:10: arm.length: expected a number > 0 [m], got 0");
  EXPECT_EQ(errorOf("[[arm]]\nat = [0, 0, 0]\nlinks = [{ length = 1 }, { mass = 2 }]\n"),
            "test.toml:3:26: arm.links: expected a value for 'length'");
  EXPECT_EQ(errorOf(kArm + "angles_degrees = [1, 2]\n"),
            "test.toml:6:18: arm.angles_degrees: expected a number or 6 numbers, one per link, "
            "got 2");
  EXPECT_EQ(errorOf(kArm + "bend_degrees = 30\n"),
            "test.toml:6:16: arm.bend_degrees: expected none: a hinge has 'limits_degrees'");
  EXPECT_EQ(errorOf(kArm + "limits_degrees = [10, 20]\n"),
            "test.toml:1:1: arm: link 0: expected a start within its limits");
  EXPECT_EQ(errorOf(kArm + "target = [1, 0, 0]\nfollow = \"arm\"\n"),
            "test.toml:7:10: arm.follow: no body 'arm'");
  EXPECT_EQ(errorOf(kArm + "targets = [{ time = 1, at = [1, 0, 0] }, { time = 1, at = [0, 0, 0] "
                           "}]\n"),
            "test.toml:6:51: arm.targets.time: expected times that increase, got 1 after 1");
  EXPECT_EQ(errorOf(kArm + "inertia = [1, 0, 0]\n"),
            "test.toml:1:1: arm: link 0: expected moments of inertia of which none exceeds the sum "
            "of the other two");
}

TEST(ArmWord, ReportsItsErrorAmongTheMetrics) {
  const Simulation simulation(sceneOf(kArm + "target = [0, 0.9, 0]\n"));
  EXPECT_NEAR(simulation.metrics().errors.at(0).largest, 1.5, 1e-12);
}

Checker::Verdict verdictOnFile(const std::string& path, const std::string& metric) {
  const Scene scene = readScene(libraryFolder() + "/../figures/panels/" + path);
  Simulation simulation(scene);
  Checker checker(scene);
  for (int i = 0; i < scene.frameCount(); ++i) {
    checker.observe(simulation);
    simulation.advance();
  }
  for (const Checker::Verdict& verdict : checker.verdicts()) {
    if (verdict.expectation.metric == metric) return verdict;
  }
  return {};
}

TEST(ArmPanels, BendAtTheTipWithMassAndAllOverWithout) {  // NOTES, figure 10
  EXPECT_NEAR(verdictOnFile("ik_mass_weighted.toml", "arm_tip_share").value, 0.72, 0.005);
  EXPECT_NEAR(verdictOnFile("ik_pseudo_inverse.toml", "arm_tip_share").value, 0.36, 0.005);
  EXPECT_NEAR(verdictOnFile("ik_mass_weighted.toml", "arm_effort").value, 0.039, 0.0005);
  EXPECT_NEAR(verdictOnFile("ik_pseudo_inverse.toml", "arm_effort").value, 0.413, 0.0005);
}

}  // namespace
}  // namespace scenes
