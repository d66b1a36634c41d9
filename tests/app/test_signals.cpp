// Signals at moments drawn from a fixed seed: nothing half is left, and the next run gives the
// bytes of a run that nobody disturbed.
#include <signal.h>

#include <chrono>
#include <random>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSheet = R"(title = "A fall"
claim = "Things fall."
video = true
[[panel]]
name = "fall"
scene = "./drop.toml"
frames = [0, 10]
)";
constexpr const char* kCase = R"(title = "A ball falls"
about = "How far it falls."
scene = "./drop.toml"
fps = 10
duration = 0.3
[[quantity]]
metric = "y"
body = "ball"
law = [0.6, 0, -4.905]
[sweep]
methods = ["paper", "bdf2", "xpbd"]
steps = [1, 8, 64, 512, 4096]
)";

class Signals : public Program {
 protected:
  static constexpr const char* kRender =
      "render drop.toml --quiet --quality draft --size 160x90 --set duration=5 ";

  void expectNothingHalf(const fs::path& where) const {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder / where)) {
      EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
  }
  fs::path frame(const char* run, int number) const {
    const std::string digits = std::to_string(number);
    return folder / run / "frames" / (std::string(5 - digits.size(), '0') + digits + ".png");
  }
  // The measured columns of a study's table, without times.
  std::vector<std::string> measured(const char* run) const {
    std::vector<std::string> rows;
    for (const std::string& row : lines(readBytes(folder / run / "points.csv"))) {
      std::string kept;
      for (std::size_t i = 0; i < 20; ++i) kept += cells(row).at(i) + ",";
      rows.push_back(kept);
    }
    return rows;
  }
};

TEST_F(Signals, ARenderKilledAgainAndAgainEndsInTheSameBytes) {
  ASSERT_EQ(run(kRender + std::string("-o whole")).code, 0);
  const std::string command = kRender + std::string("-o killed --threads 2");
  std::mt19937 random(20);
  fs::create_directories(folder / "killed" / "frames");
  for (int kill = 0; kill < 6; ++kill) {
    const auto drawn = static_cast<int>(folderBytes(folder / "killed" / "frames").size());
    const int next = drawn + 2 + static_cast<int>(random() % 5);  // not there yet
    const int signal = kill % 3 == 2 ? SIGTERM : SIGKILL;
    const int code = runAndSignal(command, frame("killed", next), signal);
    EXPECT_EQ(code, signal == SIGTERM ? 130 : 128 + SIGKILL) << "at frame " << next;
  }
  ASSERT_EQ(run(command).code, 0);
  EXPECT_EQ(folderBytes(folder / "whole" / "frames"), folderBytes(folder / "killed" / "frames"));
  expectNothingHalf("killed");
}

// A table of an earlier run stays until a new one is whole.
TEST_F(Signals, ATrajectoryIsWholeOrAsBefore) {
  const std::string command = "simulate drop.toml --quiet --set duration=300 --trajectory ";
  for (const int signal : {SIGKILL, SIGTERM, SIGINT}) {
    writeText(folder / "t.csv", "of an earlier run");
    const int code = runAndSignal(command + "t.csv", folder / "t.csv.part", signal);
    EXPECT_EQ(code, signal == SIGKILL ? 128 + SIGKILL : 130);
    EXPECT_EQ(readBytes(folder / "t.csv"), "of an earlier run");
    EXPECT_EQ(fs::remove(folder / "t.csv.part"), signal == SIGKILL);
  }
  const std::string shorter = "simulate drop.toml --quiet --trajectory ";
  writeText(folder / "t.csv.part", "of a killed run, and longer than what is to come\n");
  ASSERT_EQ(run(shorter + "t.csv").code, 0);
  ASSERT_EQ(run(shorter + "whole.csv").code, 0);
  EXPECT_EQ(readBytes(folder / "t.csv"), readBytes(folder / "whole.csv"));
  EXPECT_FALSE(fs::exists(folder / "t.csv.part"));
}

TEST_F(Signals, FiguresThatWereStoppedEndInTheSameBytes) {
  writeText(folder / "fall.toml", kSheet);
  std::string drop = readBytes(folder / "drop.toml");  // so long that a signal comes before its end
  drop.replace(drop.find("duration = 0.316666667"), 22, "duration = 0.8");
  writeText(folder / "drop.toml", drop);
  const std::string command =
      "figures fall.toml --quality draft --width 320 --quiet --threads 1 -o ";
  ASSERT_EQ(run(command + "whole").code, 0);
  int number = 1;
  for (const int signal : {SIGTERM, SIGKILL}) {
    const fs::path marker = frame("stopped/fall", number);
    const int code = runAndSignal(command + "stopped", marker, signal);
    EXPECT_EQ(code, signal == SIGKILL ? 128 + SIGKILL : 130);
    EXPECT_FALSE(fs::exists(folder / "stopped" / "fall.json"));
    number += 3;
  }
  ASSERT_EQ(run(command + "stopped").code, 0);
  for (const char* file : {"fall.png", "fall.csv", "fall.mp4"}) {
    EXPECT_EQ(readBytes(folder / "whole" / file), readBytes(folder / "stopped" / file)) << file;
  }
  expectNothingHalf("stopped");
}

// Frames of minutes: the program cannot ask between them whether a signal came.
TEST_F(Signals, ALongFrameEndsWithinASecond) {
  const std::string slow =
      " drop.toml --quiet --set simulation.method=xpbd --set simulation.substeps=1000000"
      " --set simulation.iterations=1000 -o long ";
  for (const char* command : {"simulate --trajectory t.csv", "render --size 160x90", "check"}) {
    for (const char* signal : {"INT", "TERM"}) {
      const auto begin = std::chrono::steady_clock::now();
      const Outcome outcome =
          run(command + slow,
              std::string("timeout --foreground --preserve-status -k 20 -s ") + signal + " 1");
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      EXPECT_EQ(outcome.code, 130) << command << outcome.errors;
      EXPECT_LT(took.count(), 2.0 + 0.5) << command;  // a second until it is sent; a busy machine
      EXPECT_NE(outcome.errors.find("interrupted"), std::string::npos) << outcome.errors;
      EXPECT_FALSE(fs::exists(folder / "t.csv.part"));
    }
  }
}

// The camera fits the whole motion: a picture from half of it would be another one.
TEST_F(Signals, GoldenImagesAreNotJudgedOrReplacedFromHalfAMotion) {
  std::string text = readBytes(folder / "drop.toml");
  text.replace(text.find("[camera]"), text.find("[golden]") - text.find("[camera]"),
               "[camera]\ndirection = [0, -0.2, -1]\n");
  text.replace(text.find("duration = 0.3"), 14, "duration = 30000.3");
  text.replace(text.find("[0, 6]"), 6, "[0, 1500000]");
  writeText(folder / "long.toml", text);
  for (const char* command : {"golden check long.toml --goldens g -o out",
                              "golden update long.toml --goldens g --reason r"}) {
    const Outcome outcome = run(command, "timeout --foreground --preserve-status -s TERM 1");
    EXPECT_EQ(outcome.code, 130) << command << outcome.errors;
    EXPECT_EQ(outcome.output.find("FAIL"), std::string::npos) << outcome.output;
    EXPECT_FALSE(fs::exists(folder / "g"));
  }
}

TEST_F(Signals, AStudyKilledAtAnyMomentGoesOnToTheSameTable) {
  writeText(folder / "ball.toml", kCase);
  const std::string command = "study accuracy ball.toml --progress none -o ";
  ASSERT_EQ(run(command + "whole").code, 0);
  const fs::path table = folder / "killed" / "runs.jsonl";
  for (const int signal : {SIGKILL, SIGTERM}) {
    EXPECT_NE(runAndSignal(command + "killed", table, signal), 0);
  }
  ASSERT_EQ(run(command + "killed").code, 0);
  EXPECT_EQ(measured("whole"), measured("killed"));
  expectNothingHalf("killed");
}

}  // namespace
}  // namespace tests
