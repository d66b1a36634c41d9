// Figures: their bones, poses, limits and scripts.
#include <gtest/gtest.h>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

using physics::Vec3;

const std::string kDriven = "[[ragdoll]]\ndrive = { stiffness = 300 }\n";

Vec3 at(const Simulation& simulation, const std::string& name) {
  return simulation.world().bodies().pose[simulation.findBody(name)].x;
}

TEST(Ragdoll, OfAHumanHasSeventeenBonesAndSeventyFiveKilograms) {
  const Simulation simulation(sceneOf("[[ragdoll]]\n"));
  EXPECT_EQ(simulation.world().bodyCount() - 1, 17);
  double mass = 0;
  for (int b = 1; b <= 17; ++b) mass += simulation.world().bodies().mass[b];
  EXPECT_NEAR(mass, 75, 1e-9);
}

TEST(Ragdoll, StandsWithItsLowestPointAtItsPlace) {
  const Simulation simulation(sceneOf("[[ragdoll]]\nposition = [1, 2, 3]\n"));
  EXPECT_NEAR(at(simulation, "ragdoll.0.foot_l").y(), 2.035, 1e-12);
  EXPECT_NEAR(at(simulation, "ragdoll.0.pelvis").x(), 1, 1e-12);
}

TEST(Ragdoll, RaisesItsArmsToTheSidesInTPose) {
  const Simulation simulation(sceneOf("[[ragdoll]]\npose = \"t_pose\"\n"));
  EXPECT_NEAR(at(simulation, "ragdoll.hand_l").y(), at(simulation, "ragdoll.upper_arm_l").y(),
              1e-9);
  EXPECT_GT(at(simulation, "ragdoll.hand_l").x(), 0.7);
}

class RagdollPose : public testing::TestWithParam<const char*> {};

TEST_P(RagdollPose, KeepsJointsClosedAndLimits) {
  const Simulation simulation(sceneOf("[[ragdoll]]\npose = \"" + std::string(GetParam()) + "\"\n"));
  for (const physics::KindError& error : simulation.world().constraintErrors()) {
    EXPECT_LT(error.largest, 1e-6) << error.kind << " " << error.worst;
  }
}

INSTANTIATE_TEST_SUITE_P(Poses, RagdollPose,
                         testing::Values("stand", "t_pose", "arms_up", "guard", "crouch", "stride",
                                         "reach"),
                         [](const auto& pose) { return std::string(pose.param); });

TEST(Ragdoll, CopiesAreNamedByIndexAndBone) {
  const Simulation simulation(
      sceneOf("[[ragdoll]]\nname = \"d\"\ncopies = { counts = [2, 1, 2] }\n"));
  EXPECT_EQ(simulation.world().bodyCount() - 1, 4 * 17);
  EXPECT_GE(simulation.findBody("d.3.head"), 0);
  EXPECT_EQ(simulation.findBody("d.head"), -1);
}

TEST(Ragdoll, FollowsItsPoses) {
  Simulation simulation(sceneOf(kDriven + "fixed = [\"pelvis\"]\nposes = [{ time = 0, pose = "
                                          "\"stand\" }, { time = 1, pose = \"t_pose\" }]\n"));
  for (int i = 0; i < 120; ++i) simulation.advance();
  EXPECT_GT(at(simulation, "ragdoll.hand_l").x(), 0.6);
}

TEST(Ragdoll, FollowsItsPosesAgainAndAgainWhereTheyRepeat) {
  const std::string poses =
      "fixed = [\"pelvis\"]\nrepeat = true\nposes = [{ time = 0, pose = \"stand\" }, { time = 1, "
      "pose "
      "= \"t_pose\" }, { time = 2, pose = \"stand\" }]\n";
  Simulation simulation(sceneOf(kDriven + poses));
  const auto handAt = [&](int frame) {
    while (simulation.frame() < frame) simulation.advance();
    return at(simulation, "ragdoll.hand_l").x();
  };
  EXPECT_LT(handAt(7 * 60 - 60), 0.4);  // 6 s: as at the start
  EXPECT_GT(handAt(7 * 60 + 5), 0.6);   // 7 s, and a little later for the drive's lag
}

TEST(Ragdoll, RefusesToRepeatOnePose) {
  EXPECT_EQ(errorOf(kDriven + "repeat = true\nposes = [{ time = 0, pose = \"stand\" }]\n"),
            "test.toml:3:10: ragdoll.repeat: expected at least two 'poses' to repeat");
}

TEST(Ragdoll, WantsADriveForItsPoses) {
  EXPECT_EQ(errorOf("[[ragdoll]]\nposes = [{ time = 0, pose = \"stand\" }]\n"),
            "test.toml:2:9: ragdoll.poses: expected a 'drive' as well, which follows the poses");
}

TEST(Ragdoll, NamesTheNearestPoseForAnUnknownOne) {
  EXPECT_EQ(
      errorOf("[[ragdoll]]\npose = \"crouchh\"\n"),
      "test.toml:2:8: ragdoll.pose: no 'crouchh' in assets/poses or beside the scene; did you "
      "mean 'crouch'?");
}

TEST(Ragdoll, NamesTheNearestBoneForAnUnknownOne) {
  EXPECT_EQ(errorOf("[[ragdoll]]\nfixed = [\"pelvus\"]\n"),
            "test.toml:2:9: ragdoll.fixed: no bone 'pelvus'; did you mean 'pelvis'?");
}

TEST(Ragdoll, RefusesPosesOutOfOrder) {
  EXPECT_EQ(errorOf(kDriven + "poses = [{ time = 1, pose = \"stand\" }, { time = 0, pose = "
                              "\"stand\" }]\n"),
            "test.toml:3:49: ragdoll.poses.time: expected times that increase, got 0 after 1");
}

}  // namespace
}  // namespace scenes
