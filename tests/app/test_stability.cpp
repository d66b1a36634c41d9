// dbd study stability as a user meets it: small cases from their files to the page.
#include <csignal>

#include "program.h"

namespace tests {
namespace {

namespace fs = std::filesystem;

// x = speed * t for a second.
std::string flight(const std::string& speed, const std::string& bound,
                   const std::string& more = "") {
  return "title = \"A stone flies\"\nduration = 1\n[stability]\nfamily = \"chains\"\n"
         "about = \"It may come so far.\"\nmethods = [\"paper\"]\n" +
         more + "[simulation]\nfps = 10\n[[body]]\nname = \"stone\"\n" +
         "shape = { sphere = { radius = 0.5 } }\nmass = 1\nvelocity = [" + speed +
         ", 0, 0]\n[[expect]]\nmetric = \"x\"\nbody = \"stone\"\n" + bound;
}
const std::string kSeverity =
    "[severity]\nset = \"body.stone.velocity.0\"\nfrom = 1\nto = 10\nscale = \"linear\"\n"
    "label = \"speed\"\nunit = \"m/s\"\n";

class Stability : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    writeText(folder / "holds.toml", flight("2.0", "at_most = 4.4567\n", kSeverity));
    writeText(folder / "fails.toml", flight("1.0", "at_most = 0.55\n"));
  }
  Outcome study(const std::string& arguments, const std::string& prefix = "") const {
    return run("study stability -o s --progress none " + arguments, prefix);
  }
  std::string file(const std::string& name) const { return readBytes(folder / "s" / name); }
};

TEST_F(Stability, WhatHoldsIsShownWithItsNumbers) {
  const Outcome outcome = study("holds.toml");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("ok    holds"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("x of stone 2 m <= 4.457 m: 44.9 % of the bound"),
            std::string::npos);
  EXPECT_EQ(cells(lines(file("cases.csv")).at(1)).at(2), "holds");
  EXPECT_NE(file("index.html").find("It may come so far."), std::string::npos);
}

TEST_F(Stability, WhatFailsNamesFrameBodyAndTheCommandThatDrawsIt) {
  const Outcome outcome = study("fails.toml");
  EXPECT_EQ(outcome.code, 3) << outcome.errors;
  EXPECT_NE(
      outcome.output.find("first bad frame 6 (0.6 s): x of stone 0.6 m, expected <= 0.55 m, at "
                          "stone\n"),
      std::string::npos)
      << outcome.output;
  const std::string command = "dbd render fails.toml --frames 5:8 --overlays contacts,joints";
  EXPECT_NE(outcome.output.find(command + "\n"), std::string::npos) << outcome.output;
  const Outcome drawn = run(command.substr(4) + " --size 64x64 --quality draft -o r");
  EXPECT_EQ(drawn.code, 0) << drawn.errors;
  EXPECT_TRUE(fs::exists(folder / "r" / "frames" / "00006.png"));
  int pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder / "s" / "shots")) {
    pictures += entry.path().extension() == ".png" ? 1 : 0;
  }
  EXPECT_EQ(pictures, 4);  // three frames and a close-up
}

TEST_F(Stability, AConstraintThatIsNotFiniteIsNamed) {
  std::string text = flight("1e200", "at_most = 1e300\n");
  text +=
      "[[body]]\nname = \"other\"\nshape = { sphere = { radius = 0.5 } }\nmass = 1\n"
      "position = [3, 0, 0]\n[[distance]]\nbodies = [\"stone\", \"other\"]\n"
      "anchors = [[0, 0, 0], [0, 0, 0]]\nlength = 1\n";
  writeText(folder / "wild.toml", text);
  const Outcome outcome = study("wild.toml");
  EXPECT_EQ(outcome.code, 3) << outcome.output;
  EXPECT_NE(outcome.output.find("first bad frame"), std::string::npos) << outcome.output;
}

TEST_F(Stability, ACaseThatFailsOrCannotBeReadDoesNotStopTheOthers) {
  const fs::path home = folder / "home", studies = home / "scenes" / "studies";
  fs::create_directories(studies / "stability");
  fs::create_directories(home / "scenes" / "library");
  for (const char* name : {"methods.toml", "stability_families.toml"}) {
    fs::copy_file(fs::path(DBD_SOURCE) / "scenes" / "studies" / name, studies / name);
  }
  for (const char* name : {"holds.toml", "fails.toml"}) {
    fs::copy_file(folder / name, studies / "stability" / name);
  }
  writeText(studies / "stability" / "broken.toml", "[stability]\nfamily = 3\n");
  const Outcome outcome = study("", "DBD_HOME='" + home.string() + "'");
  EXPECT_EQ(outcome.code, 3) << outcome.errors;
  EXPECT_NE(outcome.output.find("FAIL  broken"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("broken.toml:2:10: stability.family: expected"), std::string::npos);
  EXPECT_NE(outcome.output.find("FAIL  fails"), std::string::npos);
  EXPECT_NE(outcome.output.find("ok    holds"), std::string::npos);
  EXPECT_NE(outcome.output.find("1 of 3 cases hold"), std::string::npos);
}

TEST_F(Stability, SeverityFindsTheBorderAndWhatFailsThere) {
  const Outcome outcome = study("holds.toml --severity search");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const std::vector<std::string> rows = lines(file("severity.csv"));
  ASSERT_EQ(rows.size(), 3u);  // heads, the family's settings, "paper"
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::vector<std::string> row = cells(rows[i]);
    const double holds = std::stod(row.at(7)), fails = std::stod(row.at(8));  // m/s, for 1 s
    EXPECT_LT(holds, 4.4567) << rows[i];
    EXPECT_GT(fails, 4.4567);
    EXPECT_LT(fails - holds, 0.13);  // 8 m/s halved six times
    EXPECT_EQ(row.at(12), "stone");
    EXPECT_EQ(row.at(14), "10");  // the last frame
  }
  for (const char* name : {"map_chains.svg", "map_chains.png"}) {
    EXPECT_GT(file(name).size(), 1000u) << name;
  }
}

TEST_F(Stability, AnInterruptedStudyGoesOnToTheSameTables) {
  ASSERT_EQ(study("holds.toml --severity search").code, 0);
  const std::string table = file("severity.csv");
  const std::vector<std::string> runs = lines(file("runs.jsonl"));
  ASSERT_GT(runs.size(), 6u);
  // As it is found when the program was killed while it wrote the fifth line.
  writeText(folder / "s" / "runs.jsonl", runs[0] + "\n" + runs[1] + "\n" + runs[2] + "\n" +
                                             runs[3] + "\n" + runs[4].substr(0, 40));
  const Outcome outcome = study("holds.toml --severity search");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("; 4 runs were made before"), std::string::npos) << outcome.output;
  EXPECT_EQ(file("severity.csv"), table);
  EXPECT_EQ(lines(file("runs.jsonl")).size(), runs.size());
}

TEST_F(Stability, ResultsAreTheSameOnAnyNumberOfThreads) {
  ASSERT_EQ(study("holds.toml fails.toml --severity search --threads 1").code, 3);
  const std::string table = file("severity.csv");
  ASSERT_EQ(study("holds.toml fails.toml --severity search --threads 3 --fresh").code, 3);
  EXPECT_EQ(file("severity.csv"), table);
}

TEST_F(Stability, CtrlCEndsItWith130) {
  std::string text = flight("1.0", "at_most = 1e9\n");
  text.replace(text.find("duration = 1"), 12, "duration = 100000");
  writeText(folder / "long.toml", text);
  EXPECT_EQ(runAndSignal("study stability long.toml -o s --progress none",
                         folder / "s" / "runs.jsonl", SIGINT),
            130);
}

TEST_F(Stability, AMistakeIsToldAtItsPlaceAndListRunsNothing) {
  writeText(folder / "fails.toml", flight("1.0", "at_most = 1\n", "quik = true\n"));
  const Outcome outcome = study("fails.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.errors,
            "dbd: fails.toml:7:1: stability: unknown key 'quik'; did you mean 'quick'?\n");
  EXPECT_EQ(study("no_such_case").code, 2);
  EXPECT_EQ(study("holds.toml --severity serch").code, 2);
  const Outcome list = study("holds.toml --list");
  EXPECT_EQ(list.code, 0);
  EXPECT_NE(list.output.find("A stone flies"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "s"));
}

}  // namespace
}  // namespace tests
