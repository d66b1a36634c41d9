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
  writeText(folder / "run" / "frames" / "00003.png", "kept as it is");
  fs::remove(folder / "run" / "frames" / "00004.png");
  ASSERT_EQ(run(kSmall + std::string("-o run")).code, 0);
  EXPECT_EQ(readBytes(folder / "run" / "frames" / "00003.png"), "kept as it is");
  EXPECT_TRUE(fs::exists(folder / "run" / "frames" / "00004.png"));
  ASSERT_EQ(run(kSmall + std::string("-o run --fresh")).code, 0);
  EXPECT_NE(readBytes(folder / "run" / "frames" / "00003.png"), "kept as it is");
}

TEST_F(Render, AChangedSceneOrPictureIsDrawnAnew) {
  ASSERT_EQ(run(kSmall + std::string("-o run --frames 0:3")).code, 0);
  const std::string ends = " -o run --frames 0:3";
  for (const std::string& changed :
       {kSmall + std::string("--set body.ball.position=[0,0.7,0]"), kOdd + std::string(),
        kOdd + std::string("--hud"), kOdd + std::string("--overlays masses")}) {
    const std::string before = readBytes(folder / "run" / "frames" / "00001.png");
    const Outcome outcome = run(changed + ends);
    ASSERT_EQ(outcome.code, 0) << outcome.errors;
    EXPECT_NE(outcome.errors.find("drawn again"), std::string::npos) << changed;
    EXPECT_NE(readBytes(folder / "run" / "frames" / "00001.png"), before) << changed;
  }
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
