// dbd study effects as a user meets it: a small scene from its file to its page.
#include <csignal>
#include <regex>

#include "app/study/effects.h"
#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

// A box slides down its own way: gravity, contact and friction can be taken out, its inertia not.
constexpr const char* kSlide = R"(title = "A box slides"
duration = 0.5
[gravity]
acceleration = [3, -10, 0]
[contact]
friction = 0.1
[[body]]
shape = { plane = {} }
[[body]]
name = "box"
shape = { box = { size = [1, 0.5, 1] } }
mass = 1
position = [0, 0.25, 0]
[[expect]]
metric = "height"
body = "box"
at_least = 0.2
)";

class StudyEffects : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    writeText(folder / "slide.toml", kSlide);
  }
  Outcome study(const std::string& arguments, const std::string& prefix = "") const {
    return run("study effects slide.toml -o s --progress none --steps 10 " + arguments, prefix);
  }
  std::vector<std::string> rows() const { return lines(readBytes(folder / "s" / "points.csv")); }
  // The row of a trial, by the heads.
  std::string cell(const std::string& trial, const std::string& head) const {
    const std::vector<std::string> all = rows(), heads = cells(all.at(0));
    for (const std::string& row : all) {
      if (cells(row).at(1) != trial) continue;
      for (std::size_t i = 0; i < heads.size(); ++i) {
        const std::vector<std::string> own = cells(row);
        if (heads[i] == head) return i < own.size() ? own[i] : "";
      }
    }
    return "none";
  }
};

TEST_F(StudyEffects, EachIsTakenOutAndTheEndIsCompared) {
  const Outcome outcome = study("--repeats 3");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  for (const char* trial : {"as it is", "gravity", "contact", "friction", "everything on"}) {
    EXPECT_EQ(cell(trial, "status"), "ok") << trial;
    EXPECT_EQ(cell(trial, "repeats"), "3") << trial;
    EXPECT_EQ(cell(trial, "steps"), "10") << trial;
    EXPECT_GT(std::stod(cell(trial, "processor")), 0) << trial;
  }
  EXPECT_EQ(cell("as it is", "error"), "0");
  EXPECT_EQ(cell("rotation", "status"), "none");  // it cannot be taken out
  // Without friction it slides by mu g t^2 / 2 more: 0.1 * 10 * (1/6)^2 / 2, to first order in h.
  EXPECT_NEAR(std::stod(cell("friction", "error")), 0.0139, 0.002);
  EXPECT_EQ(cell("contact", "evaluations"), "0");
}

TEST_F(StudyEffects, WhatIsExpectedAndHoldsNoMoreIsNamed) {
  ASSERT_EQ(study("--repeats 2").code, 0);
  EXPECT_NE(cell("contact", "message").find("height of box"), std::string::npos);
  EXPECT_EQ(cell("friction", "message"), "");
  EXPECT_NE(readBytes(folder / "s" / "index.html").find("fails: height of box"), std::string::npos);
}

TEST_F(StudyEffects, PicturesAndPageAreMade) {
  ASSERT_EQ(study("--repeats 2").code, 0);
  for (const char* file : {"index.html", "slide.svg", "slide.png"}) {
    EXPECT_GT(readBytes(folder / "s" / file).size(), 1000u) << file;
  }
}

TEST_F(StudyEffects, WithoutGnuplotTheTablesAreMade) {
  const Outcome outcome = study("--repeats 2", "PATH=/nonexistent");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("apt-get install -y gnuplot-nox"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "s" / "slide.svg"));
}

TEST_F(StudyEffects, WhatWasMeasuredIsNotMeasuredAgain) {
  ASSERT_EQ(study("--repeats 2").code, 0);
  const std::vector<std::string> before = rows();
  ASSERT_EQ(study("--repeats 2").code, 0);
  EXPECT_EQ(rows(), before);
  ASSERT_EQ(study("--repeats 2 --set gravity.acceleration=[0,-5,0]").code, 0);
  EXPECT_NE(rows(), before);
}

TEST_F(StudyEffects, CtrlCEndsItWith130) {
  EXPECT_EQ(runAndSignal("study effects slide.toml -o s --progress none --repeats 1000",
                         folder / "s" / "runs.jsonl", SIGINT),
            130);
}

TEST_F(StudyEffects, TheTableIsThatOfTheReadme) {
  const Outcome outcome = study("--repeats 2 --table");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const std::vector<std::string> table = lines(outcome.output);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0], "| scene | effects on | ms/step | saved against everything on |");
  EXPECT_EQ(table[2].rfind("| `slide` | gravity, rotation, gyroscopic_torque, broad_phase, "
                           "narrow_phase, contact, friction, speculative_contact | ",
                           0),
            0u)
      << table[2];
}

TEST_F(StudyEffects, MistakesAreTold) {
  EXPECT_EQ(run("study effects chian").code, 2);
  EXPECT_EQ(run("study effects slide.toml slide.toml").code, 2);
  EXPECT_EQ(study("--repeats 0").code, 2);
  EXPECT_EQ(study("--set gravity.acceleratio=3").code, 2);
}

// The README's table says what the program says, but for times.
TEST(Readme, TableOfEffectsAgreesWithTheProgram) {
  int rows = 0;
  bool isInTable = false;
  for (const std::string& line : lines(readBytes(fs::path(DBD_SOURCE) / "README.md"))) {
    isInTable = line.rfind("| scene | effects on |", 0) == 0 || (isInTable && line[0] == '|');
    std::smatch match;
    if (!isInTable || !std::regex_search(line, match, std::regex(R"(^\| `(\w+)` \| ([^|]+) \|)"))) {
      continue;
    }
    ++rows;
    EXPECT_EQ(match[2], app::listText(scenes::effectsOf(scenes::readScene(match[1])))) << match[1];
  }
  EXPECT_EQ(rows, 10);
}

}  // namespace
}  // namespace tests
