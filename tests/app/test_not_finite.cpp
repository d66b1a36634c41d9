// Numbers that stop being finite in the middle of a run: exit code 3, who it was, and everything up
// to there kept.
#include "program.h"

namespace tests {
namespace {

// A ball that falls ever faster, until its numbers end between frames 6 and 9; the spring is what
// pulls, or a force does.
constexpr const char* kScene = R"(title = "Too fast"
duration = 2
[simulation]
fps = 10
[[body]]
name = "lost"
shape = { sphere = { radius = 0.25 } }
mass = 1
[[body]]
name = "calm"
shape = { sphere = { radius = 0.25 } }
mass = 1
position = [5, 0, 0]
[camera]
eye = [0, 1, 8]
target = [0, 0.5, 0]
[[expect]]
metric = "max_speed"
at_least = 0
)";
constexpr const char* kForce = "[[force]]\nbody = \"lost\"\nforce = [0, -1.7e308, 0]\n";

class NotFinite : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    writeText(folder / "fast.toml", std::string(kScene) + kForce);
  }
  void expectTold(const Outcome& outcome, const char* body = "body 'lost'") const {
    EXPECT_EQ(outcome.code, 3) << outcome.errors;
    for (const char* told : {"fast: not finite in the step from frame ", body}) {
      EXPECT_NE(outcome.errors.find(told), std::string::npos) << outcome.errors;
    }
  }
  std::string record() const { return readBytes(folder / "run" / "run.json"); }
};

TEST_F(NotFinite, SimulateKeepsItsTablesUpToTheLastGoodFrame) {
  const std::string command =
      "simulate fast.toml --quiet --hash -o run --trajectory t.csv --metrics m.csv";
  const Outcome outcome = run(command);
  expectTold(outcome);
  const std::size_t frames = lines(readBytes(folder / "m.csv")).size() - 1;
  EXPECT_GT(frames, 2u);
  EXPECT_LT(frames, 20u);
  const std::string table = readBytes(folder / "t.csv");
  EXPECT_EQ(lines(table).size(), 1 + 2 * frames);
  EXPECT_EQ(table.find("nan"), std::string::npos);
  EXPECT_EQ(table.find("inf"), std::string::npos);
  EXPECT_NE(record().find("\"finished\": false"), std::string::npos);
  EXPECT_NE(record().find(lines(outcome.output).back()), std::string::npos);
  const Outcome again = run(command);
  EXPECT_EQ(again.errors, outcome.errors);
  EXPECT_EQ(readBytes(folder / "t.csv"), table);
}

// Pictures have single precision: it ends before the motion does.
TEST_F(NotFinite, RenderKeepsTheFramesThatItCanDraw) {
  const Outcome outcome = run("render fast.toml --quiet --quality draft --size 160x90 -o run");
  EXPECT_EQ(outcome.code, 3) << outcome.errors;
  EXPECT_NE(outcome.errors.find("fast: frame 1 cannot be drawn"), std::string::npos)
      << outcome.errors;
  EXPECT_EQ(folderBytes(folder / "run" / "frames").size(), 1u);
  EXPECT_NE(record().find("\"finished\": false"), std::string::npos);
}

TEST_F(NotFinite, RenderKeepsItsFramesAndFailsInTheSameWayAgain) {
  writeText(folder / "fast.toml", std::string(kScene) + R"([[body]]
name = "mill"
shape = { box = { size = [0.1, 0.2, 0.3] } }
mass = 1
[[motor_torque]]
bodies = ["world", "mill"]
axis = [0, 0, 1]
stall_torque = 3e153
free_speed = 1e300
)");
  const std::string command =
      "render fast.toml --quiet --hash --quality draft --size 160x90 -o run "
      "--set simulation.method=sequential_impulses";
  const Outcome outcome = run(command);
  expectTold(outcome, "body 'mill', constraint motor_torque 0");
  const auto frames = folderBytes(folder / "run" / "frames");
  EXPECT_GT(frames.size(), 2u);
  EXPECT_LT(frames.size(), 20u);
  EXPECT_NE(record().find("\"finished\": false"), std::string::npos);
  EXPECT_EQ(lines(outcome.output).size(), 1u);  // the hash of the last frame there is
  const Outcome again = run(command);
  expectTold(again, "body 'mill'");
  EXPECT_EQ(again.output, outcome.output);
  EXPECT_EQ(folderBytes(folder / "run" / "frames"), frames);
}

TEST_F(NotFinite, CheckFailsThoughEveryExpectationHolds) {
  const Outcome outcome = run("check fast.toml --progress none -o run");
  expectTold(outcome);
  EXPECT_EQ(outcome.output.find("FAIL"), std::string::npos) << outcome.output;
}

TEST_F(NotFinite, CheckDoesNotCallItFinite) {
  writeText(folder / "fast.toml",
            std::string(kScene) + "[[expect]]\nmetric = \"finite\"\n" + kForce);
  const Outcome outcome = run("check fast.toml --progress none -o run");
  expectTold(outcome);
  EXPECT_NE(outcome.output.find("FAIL  fast               finite 0, expected >= 1"),
            std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("; the run stopped at frame "), std::string::npos)
      << outcome.output;
}

TEST_F(NotFinite, EveryMethodTellsIt) {
  for (const char* method : {"nonlinear_gauss_seidel", "direct", "linear_gauss_seidel", "xpbd",
                             "sequential_impulses", "penalty", "penalty_explicit"}) {
    SCOPED_TRACE(method);
    expectTold(run(std::string("simulate fast.toml --quiet --set simulation.method=") + method));
  }
  for (const char* stepping : {"bdf2", "symmetric"}) {
    SCOPED_TRACE(stepping);
    expectTold(
        run(std::string("simulate fast.toml --quiet --set simulation.stepping=") + stepping));
  }
}

// Found by the constraint that squares it, in every method that has constraints.
TEST_F(NotFinite, TheConstraintIsNamed) {
  writeText(folder / "drag.toml", std::string(kScene) + R"([[drag]]
body = "calm"
coefficient = 1e300
wind = [1e10, 0, 0]
)");
  for (const char* method : {"nonlinear_gauss_seidel", "direct", "linear_gauss_seidel", "xpbd",
                             "sequential_impulses", "penalty", "penalty_explicit"}) {
    const Outcome outcome =
        run(std::string("simulate drag.toml --quiet --set simulation.method=") + method);
    EXPECT_EQ(outcome.code, 3) << method;
    EXPECT_NE(outcome.errors.find("body 'calm', constraint drag 0"), std::string::npos)
        << method << ": " << outcome.errors;
  }
}

}  // namespace
}  // namespace tests
