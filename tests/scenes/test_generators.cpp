// Generators make what their words say, under the names they promise.
#include <gtest/gtest.h>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

int bodiesOf(const std::string& text) { return Simulation(sceneOf(text)).world().bodyCount() - 1; }

TEST(Generator, StackMakesItsCount) { EXPECT_EQ(bodiesOf("[[stack]]\ncount = 7\n"), 7); }

TEST(Generator, PyramidMakesTwoHundredAndTenFromABaseOfTwenty) {
  EXPECT_EQ(bodiesOf("[[pyramid]]\nbase = 20\n"), 210);
}

TEST(Generator, WallHasHalfBricksInEverySecondRow) {
  EXPECT_EQ(bodiesOf("[[wall]]\ncolumns = 4\nrows = 3\n"), 4 + 5 + 4);
}

TEST(Generator, GridMakesTheProductOfItsCounts) {
  EXPECT_EQ(bodiesOf("[[grid]]\ncounts = [2, 3, 4]\nshapes = [{ sphere = { radius = 1 } }]\n"), 24);
}

TEST(Generator, GridThatIsJoinedHasAJointBetweenAllNeighbours) {
  const Simulation simulation(sceneOf(
      "[[grid]]\ncounts = [4, 3, 2]\nshapes = [{ sphere = { radius = 1 } }]\njoined = true\n"));
  const auto errors = simulation.world().constraintErrors();
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].kind, "ball_socket");
  EXPECT_EQ(errors[0].count, 3 * 3 * 2 + 4 * 2 * 2 + 4 * 3 * 1);
  for (const physics::JointReport& joint : simulation.world().joints()) {
    const auto& pose = simulation.world().bodies().pose;
    EXPECT_NEAR((pose[joint.a].x - pose[joint.b].x).norm(), 2, 1e-12);  // neighbours, not others
  }
}

TEST(Generator, ChainWithALoadHasOneBodyMore) {
  EXPECT_EQ(bodiesOf("[[chain]]\nfrom = [0, 0, 0]\nlength = 0.2\ncount = 5\n"
                     "end = { shape = { sphere = { radius = 1 } }, mass = 9 }\n"),
            6);
}

TEST(Generator, ChainWithAHeavyLinkKeepsItsCount) {
  const Simulation simulation(sceneOf(
      "[[chain]]\nfrom = [0, 0, 0]\nlength = 0.2\ncount = 5\nmass = 1\nend = { mass = 9 }\n"));
  EXPECT_EQ(simulation.world().bodies().mass[simulation.findBody("chain.4")], 9);
}

TEST(Generator, CardHouseOfThreeStoreysHasFifteenCards) {
  EXPECT_EQ(bodiesOf("[[card_house]]\nstoreys = 3\n"), 15);
}

TEST(Generator, ArchThatIsRaisedStandsOnTwoSpringers) {
  EXPECT_EQ(bodiesOf("[[arch]]\nstones = 9\nspringer_height = 1\n"), 11);
}

TEST(Generator, ArchOnTheGroundHasStonesOnly) { EXPECT_EQ(bodiesOf("[[arch]]\nstones = 9\n"), 9); }

TEST(Generator, BowlHasAFloorAndItsWalls) { EXPECT_EQ(bodiesOf("[[bowl]]\nsides = 6\n"), 7); }

TEST(Generator, NamesItsBodiesByIndex) {
  const Simulation simulation(sceneOf("[[stack]]\nname = \"pile\"\ncount = 3\n"));
  EXPECT_EQ(simulation.bodyName(3), "pile.2");
  EXPECT_EQ(simulation.findBody("pile.0"), 1);
  EXPECT_EQ(simulation.findBody("pile.3"), -1);
}

TEST(Generator, LetsConstraintsUseItsNames) {
  EXPECT_EQ(errorOf("[[stack]]\ncount = 2\n[[distance]]\nbodies = [\"stack.0\", \"world\"]\n"),
            "no error");
}

TEST(Generator, CallsTheLastOfAChainItsEnd) {
  const Simulation simulation(sceneOf("[[chain]]\nfrom = [0, 0, 0]\nlength = 1\ncount = 4\n"));
  EXPECT_EQ(simulation.findBody("chain.end"), simulation.findBody("chain.3"));
}

TEST(Generator, RefusesMoreBodiesThanItMayMake) {
  EXPECT_EQ(errorOf("[[stack]]\ncount = 1000000\n"),
            "test.toml:2:9: stack.count: expected an integer in [1, 100000], got 1000000");
  EXPECT_EQ(errorOf("[[pyramid]]\nbase = 2000\n"),
            "test.toml:1:1: pyramid: expected at most 100000 bodies, got 2001000");
  EXPECT_EQ(errorOf("[[grid]]\ncounts = [1000, 1000, 1000]\nshapes = [{ point = {} }]\nmass = 1\n"),
            "test.toml:1:1: grid: expected at most 100000 bodies, got 1000000000");
}

TEST(Generator, RefusesMoreBodiesThanASceneMayHave) {
  const std::string half = "count = 60000\nshape = { point = {} }\nmass = 1\n";
  EXPECT_EQ(
      errorOf("[[stack]]\n" + half + "[[stack]]\nname = \"b\"\n" + half),
      "test.toml:5:1: stack: expected at most 100000 bodies in a scene, got 120000 with these");
}

TEST(Generator, RefusesAChainWhoseLinksDoNotFitItsEnds) {
  EXPECT_EQ(
      errorOf("[[chain]]\nfrom = [0, 0, 0]\nto = [3, 0, 0]\nlength = 1\ncount = 2\n"),
      "test.toml:1:1: chain: expected |to - from| = count * length of a link = 2.000000 m, got "
      "3.000000 m");
}

TEST(Generator, RepeatsItselfForASeed) {
  const std::string text =
      "[[grid]]\ncounts = [3, 3, 3]\njitter = 0.2\nturn_degrees = 90\n"
      "shapes = [{ sphere = { radius = 1 } }]\n";
  EXPECT_EQ(Simulation(sceneOf(text)).stateHash(), Simulation(sceneOf(text)).stateHash());
}

TEST(Generator, FollowsTheScenesSeed) {
  const std::string text =
      "[[grid]]\ncounts = [3, 3, 3]\njitter = 0.2\n"
      "shapes = [{ sphere = { radius = 1 } }]\n";
  EXPECT_NE(Simulation(sceneOf(text)).stateHash(),
            Simulation(sceneOf(text, {"simulation.seed=2"})).stateHash());
}

TEST(Generator, BridgeHangsByItsSagInTheMiddle) {
  const Simulation simulation(
      sceneOf("[[bridge]]\nfrom = [-2, 1, 0]\nto = [2, 1, 0]\ncount = 9\n"
              "sag = 0.3\nthickness = 0.02\n"));
  const double middle = simulation.world().bodies().pose[5].x.y();
  EXPECT_NEAR(middle, 0.7, 0.01);  // a chord lies a little above its arc
}

}  // namespace
}  // namespace scenes
