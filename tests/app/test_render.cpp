// The frames that `dbd render` draws: the same bytes whatever the threads, and after any
// interruption.
#include <signal.h>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

class Render : public Program {
 protected:
  static constexpr const char* kSmall = "render drop.toml --quiet --quality draft --size 160x90 ";
  static constexpr const char* kOdd = "render drop.toml --quiet --quality draft --size 161x91 ";
  // Long enough that a signal on its first frames comes before its end.
  static constexpr const char* kLong =
      "render drop.toml --quiet --quality draft --size 160x90 --set duration=2 ";

  void expectSameFrames(const fs::path& a, const fs::path& b) const {
    const auto framesA = folderBytes(folder / a / "frames"),
               framesB = folderBytes(folder / b / "frames");
    ASSERT_EQ(framesA.size(), framesB.size());
    for (std::size_t i = 0; i < framesA.size(); ++i) EXPECT_EQ(framesA[i], framesB[i]) << i;
  }
  bool recordSays(const fs::path& run, const std::string& text) const {
    return readBytes(folder / run / "run.json").find(text) != std::string::npos;
  }
};

TEST_F(Render, FramesAreNumberedFromZeroAndTheSameForAnyThreads) {
  ASSERT_EQ(run(kSmall + std::string("-o one --threads 1")).code, 0);
  ASSERT_EQ(run(kSmall + std::string("-o two --threads 2")).code, 0);
  EXPECT_EQ(folderBytes(folder / "one" / "frames").size(), 20u);
  EXPECT_TRUE(fs::exists(folder / "one" / "frames" / "00000.png"));
  EXPECT_TRUE(fs::exists(folder / "one" / "frames" / "00019.png"));
  expectSameFrames("one", "two");
}

TEST_F(Render, FramesChoosesAsAPythonSlice) {
  ASSERT_EQ(run(kSmall + std::string("-o some --frames 2:9:3")).code, 0);
  const auto frames = folderBytes(folder / "some" / "frames");
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[0].first, "00002.png");
  EXPECT_EQ(frames[2].first, "00008.png");
}

TEST_F(Render, AKilledRunGoesOnToTheSameBytes) {
  ASSERT_EQ(run(kLong + std::string("-o whole")).code, 0);
  for (const char* marker : {"00000.png", "00007.png", "00013.png"}) {
    const std::string arguments = kLong + std::string("-o killed --threads 1");
    EXPECT_EQ(runAndSignal(arguments, folder / "killed" / "frames" / marker, SIGKILL),
              128 + SIGKILL);
    EXPECT_TRUE(recordSays("killed", "\"finished\": false"));
    ASSERT_EQ(run(arguments).code, 0);
    EXPECT_TRUE(recordSays("killed", "\"finished\": true"));
    expectSameFrames("whole", "killed");
    fs::remove_all(folder / "killed");
  }
}

TEST_F(Render, AnInterruptedRunSaysSoAndGoesOn) {
  ASSERT_EQ(run(kLong + std::string("-o whole")).code, 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string arguments = kLong + std::string("-o stopped --threads 1");
    EXPECT_EQ(runAndSignal(arguments, folder / "stopped" / "frames" / "00001.png", signal), 130);
    EXPECT_LT(folderBytes(folder / "stopped" / "frames").size(), 121u);
    ASSERT_EQ(run(arguments).code, 0);
    expectSameFrames("whole", "stopped");
    fs::remove_all(folder / "stopped");
  }
}

TEST_F(Render, OnlyMissingFramesAreDrawnAgain) {
  ASSERT_EQ(run(kSmall + std::string("-o run")).code, 0);
  const std::string frame = readBytes(folder / "run" / "frames" / "00003.png");
  const std::string other = readBytes(folder / "run" / "frames" / "00009.png");
  writeText(folder / "run" / "frames" / "00003.png", other);
  fs::remove(folder / "run" / "frames" / "00004.png");
  ASSERT_EQ(run(kSmall + std::string("-o run")).code, 0);
  EXPECT_EQ(readBytes(folder / "run" / "frames" / "00003.png"), other);  // whole, so kept
  EXPECT_TRUE(fs::exists(folder / "run" / "frames" / "00004.png"));
  ASSERT_EQ(run(kSmall + std::string("-o run --fresh")).code, 0);
  EXPECT_EQ(readBytes(folder / "run" / "frames" / "00003.png"), frame);
}

TEST_F(Render, AFrameThatIsNotWholeIsDrawnAgain) {
  ASSERT_EQ(run(kSmall + std::string("-o run")).code, 0);
  const auto whole = folderBytes(folder / "run" / "frames");
  const std::string frame = whole[3].second;
  ASSERT_EQ(run(kOdd + std::string("-o odd --frames 3")).code, 0);
  const std::string size = readBytes(folder / "odd" / "frames" / "00003.png");
  for (const std::string& damaged :
       {std::string(), frame.substr(0, 100), frame.substr(0, frame.size() - 1), frame + "x", size,
        frame.substr(0, 60) + std::string(frame.size() - 60, '\0'),
        std::string("version https://git-lfs.github.com/spec/v1\n")}) {
    writeText(folder / "run" / "frames" / "00003.png", damaged);
    ASSERT_EQ(run(kSmall + std::string("-o run")).code, 0);
    EXPECT_EQ(folderBytes(folder / "run" / "frames"), whole) << damaged.size();
  }
}

TEST_F(Render, FramesOfAnotherRunAreKeptUntilFreshIsAskedFor) {
  ASSERT_EQ(run(kSmall + std::string("-o run --frames 0:3")).code, 0);
  const auto frames = folderBytes(folder / "run" / "frames");
  const std::string record = readBytes(folder / "run" / "run.json");
  const struct {
    std::string options, told;
  } changes[] = {
      {"--quality draft --size 161x91", "--size, width: 160 -> 161"},
      {"--quality standard --size 160x90", "--quality: \"draft\" -> \"standard\""},
      {"--quality draft --size 160x90 --hud", "--hud: false -> true"},
      {"--quality draft --size 160x90 --overlays masses", "--overlays: [] -> [\"masses\"]"},
      {"--quality draft --size 160x90 --set simulation.substeps=3", "settings.substeps: "},
      {"--quality draft --size 160x90 --set body.ball.position=[0,0.7,0]",
       "--set: [] -> [\"body.ball.position=[0,0.7,0]\"]"},
  };
  for (const auto& change : changes) {
    const Outcome refused =
        run("render drop.toml --quiet " + change.options + " -o run --frames 0:5");
    EXPECT_EQ(refused.code, 2) << change.options;
    for (const char* told : {change.told.c_str(), "holds 3 frames", "--fresh deletes"}) {
      EXPECT_NE(refused.errors.find(told), std::string::npos) << refused.errors;
    }
    EXPECT_EQ(folderBytes(folder / "run" / "frames"), frames) << change.options;
    EXPECT_EQ(readBytes(folder / "run" / "run.json"), record) << change.options;
  }
  ASSERT_EQ(run(kOdd + std::string("-o run --frames 0:2 --fresh")).code, 0);
  const auto fresh = folderBytes(folder / "run" / "frames");
  ASSERT_EQ(fresh.size(), 2u);
  EXPECT_NE(fresh[0].second, frames[0].second);
}

TEST_F(Render, FramesThatNoRecordTellsOfAreKept) {
  ASSERT_EQ(run(kSmall + std::string("-o run --frames 0:3")).code, 0);
  fs::remove(folder / "run" / "run.json");
  const auto frames = folderBytes(folder / "run" / "frames");
  const Outcome refused = run(kSmall + std::string("-o run --frames 0:3"));
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.errors.find("no readable run.json"), std::string::npos) << refused.errors;
  EXPECT_EQ(folderBytes(folder / "run" / "frames"), frames);
}

// The scene names the asset, whose text is not in the scene's.
TEST_F(Render, FramesOfAnAssetThatChangedAreKept) {
  const auto writeMesh = [this](const char* top) {
    writeText(folder / "tip.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 0 1\nv ") + top +
                                      "\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  };
  writeMesh("0 1 0");
  writeText(folder / "tip.toml", readBytes(folder / "drop.toml") +
                                     "[[body]]\nname = \"tip\"\nmass = 1\nposition = [3, 2, 0]\n"
                                     "shape = { convex = { mesh = \"./tip.obj\" } }\n");
  const std::string command = "render tip.toml --quiet --quality draft --size 160x90 -o run ";
  const Outcome first = run(command + "--frames 0:9");
  ASSERT_EQ(first.code, 0) << first.errors;
  const auto frames = folderBytes(folder / "run" / "frames");
  writeMesh("0 2 0");
  const Outcome refused = run(command);
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.errors.find("did an asset change?"), std::string::npos) << refused.errors;
  EXPECT_EQ(folderBytes(folder / "run" / "frames"), frames);
  EXPECT_EQ(run(command + "--fresh").code, 0);
}

TEST_F(Render, SimulateInTheSameFolderLeavesTheFramesGood) {
  ASSERT_EQ(run(kSmall + std::string("-o run --frames 0:3")).code, 0);
  ASSERT_EQ(run("simulate drop.toml --quiet -o run").code, 0);
  const Outcome again = run(kSmall + std::string("-o run --frames 0:3"));
  EXPECT_EQ(again.errors, "");
}

TEST_F(Render, VideoHasEveryFrame) {
  if (std::system("ffprobe -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg here";
  ASSERT_EQ(run(kOdd + std::string("-o run --video")).code, 0);
  const std::string count =
      "cd '" + folder.string() +
      "' && ffprobe -v error -count_packets -select_streams v:0 -show_entries "
      "stream=nb_read_packets,codec_name -of csv=p=0 run/drop.mp4 > count.txt";
  ASSERT_EQ(std::system(count.c_str()), 0);
  EXPECT_EQ(lines(readBytes(folder / "count.txt")).at(0), "h264,20");
}

}  // namespace
}  // namespace tests
