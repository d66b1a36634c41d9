// A motion is simulated once: what is drawn from its file is what a simulation draws.
#include <signal.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

class MotionFile : public Program {
 protected:
  static constexpr const char* kDraw = " --quiet --quality draft --size 160x90 ";
  // The camera fits the motion, which has to be known before the first frame is drawn.
  void SetUp() override {
    Program::SetUp();
    std::string text = readBytes(folder / "drop.toml");
    const std::size_t from = text.find("[camera]");
    text.replace(from, text.find("[golden]") - from, "[camera]\ndirection = [0, -0.2, -1]\n");
    writeText(folder / "fit.toml", text);
  }
  auto frames(const std::string& run) const { return folderBytes(folder / run / "frames"); }
  double simulated(const std::string& run) const {
    return nlohmann::json::parse(readBytes(folder / run / "run.json"))
        .at("seconds")
        .value("simulate", 0.0);
  }
};

TEST_F(MotionFile, DrawsTheSameBytesAsASimulation) {
  ASSERT_EQ(run("simulate fit.toml --quiet --motion m.npz").code, 0);
  for (const std::string how : {"", "--hud", "--overlays contacts,impulses,masses,vectors"}) {
    const std::string draw = kDraw + how + " --fresh -o ";
    ASSERT_EQ(run("render fit.toml" + draw + "stepped").code, 0) << how;
    const Outcome outcome = run("render --from m.npz" + draw + "again");
    ASSERT_EQ(outcome.code, 0) << how << outcome.errors;
    EXPECT_EQ(frames("stepped"), frames("again")) << how;
    ASSERT_EQ(frames("again").size(), 20u);
    EXPECT_EQ(simulated("again"), 0);
  }
}

TEST_F(MotionFile, IsDrawnFromAnotherSideAndInParts) {
  ASSERT_EQ(run("simulate fit.toml --quiet --motion m.npz").code, 0);
  const std::string other = " --set 'camera.direction=[1, 0, 0]'";
  const std::string draw = std::string("render --from m.npz") + kDraw;
  ASSERT_EQ(run("render fit.toml" + other + kDraw + "-o whole").code, 0);
  ASSERT_EQ(run(draw + other + " --frames 0::2 -o parts").code, 0);
  ASSERT_EQ(run(draw + other + " --frames 1::2 -o parts").code, 0);
  EXPECT_EQ(frames("whole"), frames("parts"));
  ASSERT_EQ(run(draw + "-o front").code, 0);
  EXPECT_NE(frames("whole"), frames("front"));
}

TEST_F(MotionFile, AKilledDrawingDoesNotSimulateAgain) {
  const std::string command =
      std::string("render fit.toml") + kDraw + "--set duration=2 --threads 2 -o ";
  ASSERT_EQ(run(command + "whole").code, 0);
  EXPECT_EQ(runAndSignal(command + "killed", folder / "killed" / "frames" / "00007.png", SIGKILL),
            128 + SIGKILL);
  ASSERT_TRUE(fs::exists(folder / "killed" / "motion.npz"));
  ASSERT_EQ(run(command + "killed").code, 0);
  EXPECT_EQ(frames("whole"), frames("killed"));
  EXPECT_EQ(readBytes(folder / "whole" / "motion.npz"),
            readBytes(folder / "killed" / "motion.npz"));
  EXPECT_EQ(simulated("killed"), 0);  // the first run was killed before it told its own
}

TEST_F(MotionFile, OfAnotherSceneIsRefused) {
  ASSERT_EQ(run("simulate fit.toml --quiet --motion m.npz").code, 0);
  const struct {
    std::string arguments, told;
  } cases[] = {
      {"render fit.toml --from m.npz --set body.ball.position=[0,3,0]", "the motion of other"},
      {"render chain --from m.npz", "the motion of other"},
      {"render --from none.npz", "none.npz"},
      {"render --from drop.toml", "no .npz file"},
      {"render", "SCENE or --from"},
  };
  for (const auto& wrong : cases) {
    const Outcome outcome = run(wrong.arguments + " -o refused");
    EXPECT_EQ(outcome.code, 2) << wrong.arguments;
    EXPECT_NE(outcome.errors.find(wrong.told), std::string::npos) << outcome.errors;
  }
}

TEST_F(MotionFile, DamagedOneIsRefusedAndAnEarlierOneMadeAgain) {
  ASSERT_EQ(run(std::string("render fit.toml") + kDraw + "-o run").code, 0);
  const auto drawn = frames("run");
  const fs::path file = folder / "run" / "motion.npz";
  std::string bytes = readBytes(file);
  const std::string whole = bytes;
  bytes[bytes.size() / 3] = static_cast<char>(bytes[bytes.size() / 3] ^ 1);
  writeText(file, bytes);
  const Outcome refused = run("render --from run/motion.npz -o other");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.errors.find("damaged"), std::string::npos) << refused.errors;
  fs::remove(folder / "run" / "frames" / "00004.png");
  ASSERT_EQ(run(std::string("render fit.toml") + kDraw + "-o run").code, 0);
  EXPECT_EQ(frames("run"), drawn);
  EXPECT_EQ(readBytes(file), whole);
}

}  // namespace
}  // namespace tests
