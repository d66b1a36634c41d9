// A run that was stopped goes on from what it kept last, and ends in the bytes of one that nobody
// disturbed. How far each one comes before it is stopped depends on the machine, what it ends in
// does not.
#include <signal.h>

#include <random>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

class Resumed : public Program {
 protected:
  // Some second of steps, with contacts, joints and what sleeps.
  static constexpr const char* kScene =
      "wrecking_ball --set duration=1 --set simulation.substeps=1200 ";

  std::string simulate(const std::string& name) const {
    return std::string("simulate ") + kScene + "-o " + name + " --motion " + name +
           "/m.npz --trajectory " + name + "/t.csv --metrics " + name + "/metrics.csv --quiet ";
  }
  // Without the seconds that a frame took.
  std::string metrics(const std::string& name) const {
    std::string kept;
    for (const std::string& row : lines(readBytes(folder / name / "metrics.csv"))) {
      const std::vector<std::string> cell = cells(row);
      for (std::size_t i = 0; i < cell.size(); ++i) {
        if (i + 10 < cell.size() || i + 6 >= cell.size()) kept += cell[i] + ",";
      }
      kept += "\n";
    }
    return kept;
  }
  void expectSame(const std::string& whole, const std::string& resumed) const {
    for (const char* file : {"m.npz", "t.csv"}) {
      EXPECT_TRUE(readBytes(folder / whole / file) == readBytes(folder / resumed / file)) << file;
    }
    EXPECT_EQ(metrics(whole), metrics(resumed));
    EXPECT_FALSE(fs::exists(folder / resumed / "m.npz.state"));
    EXPECT_FALSE(fs::exists(folder / resumed / "m.npz.begun"));
  }
  void stop(const std::string& command, const std::string& name, int signal) const {
    EXPECT_EQ(runAndSignal(command, folder / name / "m.npz.state", signal),
              signal == SIGKILL ? 128 + SIGKILL : 130);
  }
};

TEST_F(Resumed, ASimulationKilledAtAnyMomentEndsInTheSameBytes) {
  ASSERT_EQ(run(simulate("whole")).code, 0);
  std::mt19937 random(16);
  for (int kill = 0; kill < 5; ++kill) {
    const double seconds = 0.2 + 0.1 * static_cast<double>(random() % 5);
    run(simulate("killed"), "timeout -s KILL " + std::to_string(seconds));
  }
  ASSERT_EQ(run(simulate("killed")).code, 0);
  expectSame("whole", "killed");
}

TEST_F(Resumed, OneThatWasInterruptedMakesNoFrameAgain) {
  ASSERT_EQ(run(simulate("whole")).code, 0);
  stop(simulate("stopped"), "stopped", SIGTERM);
  std::string loud = simulate("stopped");
  loud.erase(loud.find("--quiet"));
  const Outcome outcome = run(loud);
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("goes on from frame"), std::string::npos) << outcome.errors;
  expectSame("whole", "stopped");
}

TEST_F(Resumed, AFilmKilledAtAnyMomentEndsInTheSameBytes) {
  const std::string command =
      std::string("render ") + kScene + "--quiet --quality draft --size 96x54 --threads 2 -o ";
  ASSERT_EQ(run(command + "whole").code, 0);
  std::mt19937 random(17);
  for (int kill = 0; kill < 5; ++kill) {
    const double seconds = 0.4 + 0.1 * static_cast<double>(random() % 8);
    run(command + "killed", "timeout -s KILL " + std::to_string(seconds));
  }
  ASSERT_EQ(run(command + "killed").code, 0);
  EXPECT_EQ(folderBytes(folder / "whole" / "frames"), folderBytes(folder / "killed" / "frames"));
  EXPECT_TRUE(readBytes(folder / "whole" / "motion.npz") ==
              readBytes(folder / "killed" / "motion.npz"));
  EXPECT_FALSE(fs::exists(folder / "killed" / "motion.npz.state"));
}

TEST_F(Resumed, AFilmStepsNoFrameAgainThatWasDrawn) {
  const std::string command = std::string("render ") + kScene +
                              "--set 'camera={eye=[4,3,12],target=[0,2,0]}' "
                              "--set simulation.substeps=1000 --quality draft --size 96x54 "
                              "--threads 1 -o killed";
  EXPECT_EQ(runAndSignal(command, folder / "killed" / "frames" / "00008.png", SIGKILL),
            128 + SIGKILL);
  const auto drawn = static_cast<int>(folderBytes(folder / "killed" / "frames").size());
  const bool isStepped = fs::exists(folder / "killed" / "motion.npz");
  const Outcome outcome = run(command);
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  const std::string note = "goes on from frame ";
  const std::size_t at = outcome.errors.find(note);
  EXPECT_EQ(at == std::string::npos, isStepped) << outcome.errors;
  if (isStepped) return;
  EXPECT_GE(1 + std::stoi(outcome.errors.substr(at + note.size())), drawn);
}

TEST_F(Resumed, AnotherRunIsRefusedAndSaysWhatDiffers) {
  stop(simulate("stopped"), "stopped", SIGKILL);
  const std::string other = simulate("stopped") + "--set contact.friction=0.1 ";
  const Outcome refused = run(other);
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.errors.find("contact.friction"), std::string::npos) << refused.errors;
  EXPECT_NE(refused.errors.find("--fresh"), std::string::npos) << refused.errors;
  EXPECT_TRUE(fs::exists(folder / "stopped" / "m.npz.state"));
  EXPECT_EQ(run(other + "--fresh").code, 0);
  EXPECT_FALSE(fs::exists(folder / "stopped" / "m.npz.state"));
}

TEST_F(Resumed, WhatIsDamagedIsMadeAgain) {
  ASSERT_EQ(run(simulate("whole")).code, 0);
  for (const char* file : {"m.npz.begun", "m.npz.state"}) {
    stop(simulate("damaged"), "damaged", SIGKILL);
    std::string bytes = readBytes(folder / "damaged" / file);
    bytes[2000] = static_cast<char>(bytes[2000] ^ 1);
    writeText(folder / "damaged" / file, bytes);
    ASSERT_EQ(run(simulate("damaged")).code, 0);
    expectSame("whole", "damaged");
  }
}

}  // namespace
}  // namespace tests
