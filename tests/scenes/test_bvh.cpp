// Motion capture files, and figures that follow them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "physics/base/rotation.h"
#include "scenes/read/bvh.h"
#include "scenes/simulation.h"
#include "tests/fuzz/mutate.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

using physics::Vec3;

const std::string kTwoJoints =
    "HIERARCHY\n"
    "ROOT Base\n"
    "{\n"
    "  OFFSET 0 1 0\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT Hand\n"
    "  {\n"
    "    OFFSET 2 0 0\n"
    "    CHANNELS 3 Xrotation Yrotation Zrotation\n"
    "    End Site\n"
    "    {\n"
    "      OFFSET 1 0 0\n"
    "    }\n"
    "  }\n"
    "}\n"
    "MOTION\n"
    "Frames: 2\n"
    "Frame Time: 0.1\n";
const std::string kRest = "0 0 0 0 0 0 0 0 0\n", kTurned = "1 2 3 90 90 0 0 0 90\n";

std::string bvhErrorOf(const std::string& text) {
  try {
    parseBvh(text, "arm.bvh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Bvh, HasItsJointsAndFrames) {
  const Bvh bvh = parseBvh(kTwoJoints + kRest + kTurned, "arm.bvh");
  ASSERT_EQ(bvh.joints.size(), 3u);
  EXPECT_EQ(bvh.find("Hand"), 1);
  EXPECT_EQ(bvh.joints[2].parent, 1);
  EXPECT_EQ(bvh.restPoints()[2], Vec3(3, 0, 0));
  EXPECT_EQ(bvh.frameTime, 0.1);
  EXPECT_EQ(bvh.rootAt(1), Vec3(1, 3, 3));
}

// The first channel is the outermost: here z by 90 degrees of x by 90 degrees.
TEST(Bvh, TurnsInTheOrderOfItsChannels) {
  const auto turns = parseBvh(kTwoJoints + kRest + kTurned, "arm.bvh").turns(1);
  EXPECT_LT((turns[0] * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((turns[0] * Vec3::UnitY() - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_LT((turns[1] * Vec3::UnitX() - Vec3::UnitZ()).norm(), 1e-12);
}

TEST(Bvh, TellsWhereItIsWrong) {
  EXPECT_EQ(bvhErrorOf(""), "arm.bvh:0: expected more, got 'the end of the file'");
  EXPECT_EQ(bvhErrorOf(replaced(kTwoJoints, "Zrotation", "Wrotation")),
            "arm.bvh:5: expected a channel such as Zrotation, got 'Wrotation'");
  EXPECT_EQ(bvhErrorOf(replaced(kTwoJoints, "OFFSET 2 0", "OFFSET 2 x")),
            "arm.bvh:8: expected a number, got 'x'");
  EXPECT_EQ(bvhErrorOf(replaced(kTwoJoints, "JOINT Hand", "JOINT Base")),
            "arm.bvh:6: expected a new name, got 'Base'");
  EXPECT_EQ(bvhErrorOf(replaced(kTwoJoints, "JOINT", "JOIN")),
            "arm.bvh:6: expected JOINT, End Site or }, got 'JOIN'");
  EXPECT_EQ(bvhErrorOf(replaced(kTwoJoints, "CHANNELS 3", "CHANNELS 7")),
            "arm.bvh:9: expected at most 6 channels, got '7'");
  EXPECT_EQ(bvhErrorOf(replaced(kTwoJoints, "0.1", "0")),
            "arm.bvh:18: expected a time of a frame > 0 s, got '0'");
  EXPECT_EQ(bvhErrorOf(kTwoJoints + kRest + "0 0 0\n"),
            "arm.bvh:20: expected 9 numbers, one for each channel, got '3'");
  EXPECT_EQ(bvhErrorOf(kTwoJoints + kRest), "arm.bvh:19: expected 2 frames, at least one, got '1'");
}

std::string textOfWalk() {
  std::ostringstream text;
  text << std::ifstream(assetFolder() + "/motions/walk.bvh").rdbuf();
  return text.str();
}

TEST(Bvh, WithMistakesFromASeedIsReadOrRefusedAtItsLine) {
  const std::vector<std::string> files{textOfWalk(), kTwoJoints + kRest + kTurned};
  int refused = 0;
  for (int seed = 0; seed < 500; ++seed) {
    const std::string told = bvhErrorOf(tests::mutated(files, seed));
    refused += told != "no error";
    EXPECT_TRUE(told == "no error" || told.starts_with("arm.bvh:")) << seed << ": " << told;
  }
  EXPECT_GT(refused, 100);
}

const std::string kWalker =
    "[[bvh]]\nname = \"w\"\nfile = \"walk.bvh\"\nrepeat = true\n"
    "drive = { stiffness = 2000, damping = 60 }\n"
    "joints = { pelvis = \"Hips\", upper_arm_l = \"LeftArm\", forearm_l = \"LeftForeArm\", "
    "hand_l = \"LeftHand\", thigh_l = \"LeftUpLeg\", shin_l = \"LeftLeg\", foot_l = \"LeftFoot\", "
    "thigh_r = \"RightUpLeg\", shin_r = \"RightLeg\", foot_r = \"RightFoot\" }\n";

Vec3 boneAt(const Simulation& simulation, const std::string& name) {
  return simulation.world().bodies().pose[simulation.findBody(name)].x;
}

// The file holds its arms out at rest, the skeleton lets them hang.
TEST(CapturedFigure, StandsAsItsFileDoes) {
  const Simulation simulation(sceneOf(kWalker));
  EXPECT_NEAR(boneAt(simulation, "w.pelvis").y(), 0.935, 0.005);
  EXPECT_LT(boneAt(simulation, "w.hand_l").y(), boneAt(simulation, "w.upper_arm_l").y() - 0.3);
  EXPECT_GT(boneAt(simulation, "w.foot_l").z(),
            boneAt(simulation, "w.foot_r").z() + 0.4);  // a stride
}

TEST(CapturedFigure, WalksOnWhereItsFileRepeats) {
  Simulation simulation(sceneOf(kWalker));
  const Vec3 start = boneAt(simulation, "w.pelvis");
  for (int frame = 0; frame < 144; ++frame) simulation.advance();  // two strides of 1 m
  EXPECT_LT((boneAt(simulation, "w.pelvis") - start - Vec3(0, 0, 2)).norm(), 1e-4);
}

// The left knee: about x, from straight.
double kneeOf(const physics::Quat& thigh, const physics::Quat& shin) {
  return physics::logarithm(thigh.conjugate() * shin).x();
}

TEST(CapturedFigure, JointsFollowTheirFile) {
  const Bvh bvh = parseBvh(textOfWalk(), "walk.bvh");
  Simulation simulation(sceneOf(kWalker));
  for (int frame = 1; frame <= 72; ++frame) {  // two of the film to one of the file
    simulation.advance();
    if (frame < 20 || frame % 2 != 0) continue;
    const auto turnOf = [&](const char* name) {
      return simulation.world().bodies().pose[simulation.findBody(name)].q;
    };
    const auto wanted = bvh.turns(static_cast<std::size_t>(frame / 2));
    EXPECT_NEAR(kneeOf(turnOf("w.thigh_l"), turnOf("w.shin_l")),
                kneeOf(wanted[bvh.find("LeftUpLeg")], wanted[bvh.find("LeftLeg")]), 0.3)
        << frame;  // rad: the drive's damping lags behind a knee of some 10 rad/s
  }
}

TEST(CapturedFigure, FallsWhereNothingLeadsIt) {
  Simulation simulation(sceneOf("[gravity]\n[contact]\n" + kWalker + "held = false\n"));
  for (int frame = 0; frame < 60; ++frame) simulation.advance();
  EXPECT_LT(boneAt(simulation, "w.pelvis").y(), 0);
}

TEST(CapturedFigure, RefusesWhatItCannotFollow) {
  const auto without = [](const std::string& text) { return errorOf(replaced(kWalker, text, "")); };
  EXPECT_EQ(without("drive = { stiffness = 2000, damping = 60 }\n"),
            "test.toml:1:1: bvh: expected a 'drive', which follows the file");
  EXPECT_EQ(errorOf(replaced(kWalker, "\"Hips\"", "\"Hip\"")),
            "test.toml:6:21: bvh.joints.pelvis: no joint 'Hip' in the file; did you mean 'Hips'?");
  EXPECT_EQ(errorOf(replaced(kWalker, "pelvis", "pelvi")),
            "test.toml:6:12: bvh.joints: unknown key 'pelvi'; did you mean 'pelvis'?");
  EXPECT_EQ(errorOf(replaced(kWalker, "walk.bvh", "none.bvh")),
            "test.toml:3:8: bvh.file: no file 'none.bvh' beside the scene or in assets/motions");
}

}  // namespace
}  // namespace scenes
