// dbd study accuracy as a user meets it: a tiny case from its file to its page.
#include <csignal>
#include <cstdlib>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

// A body falls. Backward Euler is g h t / 2 too low: first order, exactly.
constexpr const char* kFall = R"(title = "A body falls"
duration = 1
[gravity]
acceleration = [0, -10, 0]
[[body]]
name = "stone"
shape = { sphere = { radius = 0.1 } }
mass = 1
)";
constexpr const char* kCase = R"(title = "A stone falls"
about = "Free fall against its closed form."
scene = "./fall.toml"
fps = 10
[[quantity]]
metric = "y"
body = "stone"
law = [0, 0, -5]
[sweep]
methods = ["paper"]
substeps = [2, 4, 8, 16]
)";

class Study : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    writeText(folder / "fall.toml", kFall);
    writeText(folder / "stone.toml", kCase);
  }
  Outcome study(const std::string& arguments, const std::string& prefix = "") const {
    return run("study accuracy stone.toml -o s --progress none " + arguments, prefix);
  }
  std::string bytes(const std::string& file) const { return readBytes(folder / "s" / file); }
  std::string points() const { return bytes("points.csv"); }

  // What does not depend on the clock: the columns before "wall", of every row.
  std::vector<std::string> measured() const { return measuredIn("s"); }
  std::vector<std::string> measuredIn(const std::string& where) const {
    std::vector<std::string> result;
    for (const std::string& row : lines(readBytes(folder / where / "points.csv"))) {
      const std::vector<std::string> all = cells(row);
      std::string kept;
      for (std::size_t i = 0; i < all.size() && i < 20; ++i) kept += all[i] + ",";
      result.push_back(kept);
    }
    return result;
  }
};

TEST_F(Study, FallingShowsTheFirstOrderOfThePapersSteps) {
  const Outcome outcome = study("");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("order 1.00 over 4 points"), std::string::npos) << outcome.output;
  const std::vector<std::string> rows = lines(points());
  ASSERT_EQ(rows.size(), 5u);
  // 10 m/s^2 * 1/20 s * 1 s / 2
  EXPECT_NEAR(std::stod(cells(rows[1]).at(7)), 0.25, 1e-9);
  for (const char* file : {"index.html", "stone.svg", "stone.png", "stone_h.svg", "stone_h.png"}) {
    EXPECT_GT(readBytes(folder / "s" / file).size(), 1000u) << file;
  }
}

TEST_F(Study, AMethodThatIsAskedHasItsAccuraciesInTheTableAndTheDiagrams) {
  std::string text = std::string(kCase) + "accuracies = [1e-2, 1e-5]\n";
  text.replace(text.find("[\"paper\"]"), 9, "[\"paper\", \"accuracy\"]");
  writeText(folder / "stone.toml", text);
  const Outcome outcome = study("");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("2 of 2 points (100 %) are within 3 times"), std::string::npos)
      << outcome.output;
  const std::vector<std::string> rows = lines(points()), asked = lines(bytes("asked.csv"));
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_EQ(cells(rows[0]).at(28), "accuracy");
  EXPECT_EQ(std::stod(cells(rows[4]).at(28)), 0);
  EXPECT_EQ(std::stod(cells(rows[5]).at(28)), 1e-2);
  EXPECT_EQ(std::stod(cells(rows[6]).at(28)), 1e-5);
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_EQ(asked[1].substr(0, 11), "stone,0.01,");
  EXPECT_NE(bytes("stone.gp").find("by accuracy"), std::string::npos);
  EXPECT_EQ(bytes("stone_h.gp").find("by accuracy"), std::string::npos);  // it has no h
  EXPECT_GT(bytes("asked.png").size(), 1000u);
  EXPECT_NE(bytes("index.html").find("accuracy 1e-2"), std::string::npos);
  ASSERT_EQ(run("study accuracy stone.toml --methods accuracy -o alone --quiet").code, 0);
  EXPECT_TRUE(fs::exists(folder / "alone" / "stone.png"));
  EXPECT_FALSE(fs::exists(folder / "alone" / "stone_h.png"));
}

TEST_F(Study, AnInterruptedStudyGoesOnToTheSameTable) {
  ASSERT_EQ(study("").code, 0);
  const std::vector<std::string> expected = measured(), rows = lines(points());
  const std::vector<std::string> runs = lines(bytes("runs.jsonl"));
  ASSERT_EQ(runs.size(), 4u);
  // As it is found when the program was killed while it wrote the third line.
  writeText(folder / "s" / "runs.jsonl", runs[0] + "\n" + runs[1] + "\n" + runs[2].substr(0, 25));
  ASSERT_EQ(study("").code, 0);
  EXPECT_EQ(measured(), expected);
  int same = 0;  // not measured again: their times are the same
  for (std::size_t i = 1; i < rows.size(); ++i) same += lines(points())[i] == rows[i] ? 1 : 0;
  EXPECT_EQ(same, 2);
}

TEST_F(Study, CtrlCEndsItWith130) {
  writeText(folder / "stone.toml", std::string(kCase) + "steps = [1, 100, 1000, 100000]\n");
  EXPECT_EQ(runAndSignal("study accuracy stone.toml -o s --progress none",
                         folder / "s" / "runs.jsonl", SIGINT),
            130);
  EXPECT_TRUE(fs::exists(folder / "s" / "runs.jsonl"));
}

TEST_F(Study, WhatChangedIsMeasuredAgain) {
  ASSERT_EQ(study("").code, 0);
  ASSERT_EQ(study("--set gravity.acceleration=[0,-20,0]").code, 0);
  // Half of 20 - 10 m/s^2, and the first-order error of 20 m/s^2.
  EXPECT_NEAR(std::stod(cells(lines(points())[1]).at(7)), 5.5, 1e-9);
}

TEST_F(Study, APointThatFailsIsShownAndDoesNotStopTheOthers) {
  writeText(folder / "stone.toml", std::string("scale = 1e-4\n") + kCase +
                                       "[sweep.linear]\nset = [\"simulation.relaxation=7\"]\n");
  std::string text = readBytes(folder / "stone.toml");
  text.replace(text.find("[\"paper\"]"), 9, "[\"linear\", \"paper\"]");
  writeText(folder / "stone.toml", text);
  const Outcome outcome = study("");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  const std::vector<std::string> rows = measured();
  ASSERT_EQ(rows.size(), 6u);  // what a method cannot do is asked once
  EXPECT_NE(rows[1].find("refused"), std::string::npos);
  EXPECT_NE(rows[2].find("exploded"), std::string::npos);  // 0.25 m are 2500 times the scale
  EXPECT_NE(rows[5].find(",ok,"), std::string::npos);
  EXPECT_NE(outcome.output.find("refused: --set simulation.relaxation=7"), std::string::npos);
}

// What is measured, x, is exactly right; the motion is lost all the same.
TEST_F(Study, ABodyFasterThanLightHasDiverged) {
  writeText(folder / "fall.toml", std::string(kFall) + "velocity = [0, 4e8, 0]\n");
  std::string text = kCase;
  text.replace(text.find("\"y\""), 3, "\"x\"");
  text.replace(text.find("[0, 0, -5]"), 10, "[0]");
  writeText(folder / "stone.toml", text);
  const Outcome outcome = study("");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  const std::vector<std::string> rows = measured();
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_NE(rows[1].find("diverged"), std::string::npos) << rows[1];
  EXPECT_NE(points().find("a body moves at 4e+08 m/s"), std::string::npos) << points();
  EXPECT_NE(outcome.output.find("4 failed"), std::string::npos) << outcome.output;
}

TEST_F(Study, WithoutGnuplotTheTablesAreMadeAndItSaysWhatToInstall) {
  const Outcome outcome = study("", "PATH=/nonexistent");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("apt-get install -y gnuplot-nox"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "s" / "index.html"));
  EXPECT_FALSE(fs::exists(folder / "s" / "stone.svg"));
}

TEST_F(Study, AMistakeInACaseIsToldAtItsPlace) {
  writeText(folder / "stone.toml", std::string(kCase) + "substep = [1]\n");
  const Outcome outcome = study("");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.errors,
            "dbd: stone.toml:12:1: sweep: unknown key 'substep'; did you mean 'substeps'?\n");
  EXPECT_EQ(study("--methods papr").code, 2);
  EXPECT_EQ(run("study accuracy pendulun").code, 2);
}

TEST_F(Study, AChoiceIsMeasuredWithAndWithoutIt) {
  writeText(folder / "choice.toml",
            "title = \"Gravity\"\n[with]\nlabel = \"10\"\n"
            "set = [\"simulation.method=nonlinear_gauss_seidel\"]\n[without]\nlabel = \"20\"\n"
            "set = [\"simulation.method=nonlinear_gauss_seidel\", "
            "\"gravity.acceleration=[0,-20,0]\"]\n[[trial]]\ncase = \"./stone.toml\"\n"
            "substeps = 2\n");
  const Outcome outcome = run("study options ./choice.toml -o o --progress none");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("10                       0.25 m"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("20                       5.5 m"), std::string::npos);
  EXPECT_NE(readBytes(folder / "o" / "index.html").find("<td class=\"number\">22</td>"),
            std::string::npos);
}

TEST_F(Study, AMistakeInAChoiceIsToldAtItsPlace) {
  writeText(folder / "choice.toml", "title = \"Gravity\"\n[with]\nlabel = \"10\"\n");
  const Outcome outcome = run("study options ./choice.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.errors, "dbd: ./choice.toml:1:1: expected a table [without]\n");
}

// Every time in a row, a page or a picture comes from the lines of runs.jsonl: what jobs and one
// machine make of the same lines must be the same bytes.
TEST_F(Study, JobsOnTwoProcessesMakeThePagesOfOne) {
  writeText(folder / "other.toml", kCase);
  const std::string cases = "study accuracy stone.toml other.toml --progress none ";
  ASSERT_EQ(run(cases + "-o one").code, 0);
  const Outcome jobs = run(cases + "-o jobs --jobs");
  ASSERT_EQ(jobs.code, 0) << jobs.errors;
  ASSERT_EQ(lines(jobs.output).size(), 2u);
  EXPECT_FALSE(fs::exists(folder / "jobs"));
  writeText(folder / "list", jobs.output);
  const std::string before = run(cases + "-o jobs --collect").errors;
  EXPECT_NE(before.find(jobs.output), std::string::npos) << before;  // all are missing
  ASSERT_EQ(std::system(("cd '" + folder.string() +
                         "' && xargs -d '\\n' -P2 -I{} sh -c '{} --quiet' < list && xargs -d '\\n' "
                         "-P2 -I{} sh -c "
                         "'{} --quiet' < list")
                            .c_str()),
            0);
  // As a job leaves it that was killed: it is named again, and made again.
  const fs::path file = folder / "jobs" / "runs" / "other.paper.jsonl";
  const std::vector<std::string> whole = lines(readBytes(file));
  ASSERT_EQ(whole.size(), 4u);
  writeText(file, whole[0] + "\n" + whole[1].substr(0, 30));
  const Outcome torn = run(cases + "-o jobs --collect");
  EXPECT_EQ(torn.code, 3);
  EXPECT_EQ(torn.errors,
            "dbd: not everything was run; these make the rest:\n" + lines(jobs.output)[1] + "\n");
  ASSERT_EQ(run(lines(jobs.output)[1].substr(lines(jobs.output)[1].find(" study") + 1)).code, 0);
  ASSERT_EQ(run(cases + "-o jobs --collect").code, 0);
  EXPECT_EQ(measuredIn("jobs"), measuredIn("one"));
  fs::create_directories(folder / "again");
  fs::copy_file(folder / "jobs" / "runs.jsonl", folder / "again" / "runs.jsonl");
  ASSERT_EQ(run(cases + "-o again").code, 0);
  for (const char* name : {"points.csv", "index.html", "stone.gp", "other_h.png"}) {
    EXPECT_EQ(readBytes(folder / "jobs" / name), readBytes(folder / "again" / name)) << name;
  }
}

TEST_F(Study, ARunThatIsNoneIsToldWithTheNearest) {
  const Outcome outcome = study("--run stone.papr");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("did you mean 'stone.paper'?"), std::string::npos);
}

// One loop steps, one file keeps: nothing else in the program's studies does.
TEST(StudySources, HaveOneLoopAndOneStore) {
  int loops = 0, stores = 0;
  for (const char* room : {"run", "study", "commands", "figure"}) {
    for (const auto& entry : fs::directory_iterator(fs::path(DBD_SOURCE) / "app" / room)) {
      const std::string text = readBytes(entry.path()), name = entry.path().filename().string();
      const auto count = [&](const std::string& word) {
        int found = 0;
        for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++found;
        return found;
      };
      // The clock of `dbd plan` listens to single steps.
      if (name != "step_clock.cpp") loops += count("simulation.advance()");
      if (std::string(room) == "study") stores += count("std::fopen");
    }
  }
  EXPECT_EQ(loops, 1);
  EXPECT_EQ(stores, 1);
}

TEST_F(Study, ListNamesCasesAndMeasuresNothing) {
  const Outcome outcome = study("--list");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.output.find("A stone falls"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "s"));
}

}  // namespace
}  // namespace tests
