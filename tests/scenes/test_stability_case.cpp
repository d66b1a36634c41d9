// Cases of the stability study: the family decides how they are solved, and what is wrong in them
// is told at its place.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenes/simulation.h"
#include "scenes/study/stability_case.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;

const std::string kCaseHead = "duration = 1\n[stability]\nfamily = \"chains\"\nabout = \"a\"\n";
const std::string kBody =
    "[[body]]\nname = \"p\"\nshape = { sphere = { radius = 1 } }\nmass = 3\n"
    "velocity = [2, 0, 0]\n";
const std::string kExpect = "[[expect]]\nmetric = \"x\"\nbody = \"p\"\nat_most = 5\n";
const std::string kSeverity =
    "[severity]\nset = \"body.p.mass\"\nfrom = 1\nto = 1000\nlabel = \"m\"\n";
const std::string kVariant =
    "[[variant]]\nname = \"fast\"\nset = [\"body.p.velocity=[9,0,0]\"]\n"
    "[[variant.expect]]\nmetric = \"x\"\nbody = \"p\"\nat_least = -1\n";

Scene caseSceneOf(const std::string& text, const std::vector<std::string>& set = {}) {
  return parseScene(text, "case.toml", set);
}

std::string caseErrorOf(const std::string& text, const std::vector<std::string>& set = {}) {
  try {
    caseSceneOf(text, set);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// The cases of a file with this text.
std::vector<StabilityCase> casesOf(const std::string& text, const std::string& variant = "") {
  const fs::path file =
      fs::temp_directory_path() /
      ("dbd_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
       ".toml");
  std::ofstream(file) << text;
  struct Remove {
    fs::path file;
    ~Remove() { fs::remove(file); }
  } remove{file};
  return readStabilityCases(file.string() + variant);
}

TEST(StabilityCase, SaysFramesPerSecondAlone) {
  ASSERT_FALSE(stabilityFamilies().empty());
  for (const StabilityFamily& family : stabilityFamilies()) {
    ASSERT_EQ(family.settings.members.size(), 1u) << family.name;
    const Value& simulation = family.settings.members[0].value;
    ASSERT_EQ(simulation.members.size(), 1u) << family.name;
    EXPECT_EQ(simulation.members[0].key, "fps");
  }
}

TEST(StabilityCase, IsOverriddenFromTheCommandLineAllTheSame) {
  const Scene scene = caseSceneOf(kCaseHead + kBody, {"simulation.substeps=37", "body.p.mass=5"});
  EXPECT_EQ(scene.settings.substeps, 37);
  EXPECT_EQ(Simulation(scene).world().bodies().mass[1], 5);
}

TEST(StabilityCase, MayNotSayHowItIsSolved) {
  EXPECT_EQ(
      caseErrorOf(kCaseHead + "[simulation]\nfps = 30\niterations = 9\n" + kBody).substr(0, 61),
      "case.toml:7:1: simulation.iterations: expected none: how a ca");
  EXPECT_EQ(caseErrorOf(kCaseHead + "[simulation]\nfps = 30\nseed = 4\n" + kBody), "no error");
  EXPECT_NE(caseErrorOf(kCaseHead + kBody +
                        "[[variant]]\nname = \"v\"\nset = [\"simulation.substeps=9\"]\n")
                .find("variant 'v': simulation.substeps: expected none"),
            std::string::npos);
}

TEST(StabilityCase, MaySayTheSettingThatItIsAbout) {
  const Scene scene = caseSceneOf(kCaseHead + "about_settings = [\"iterations\"]\n[simulation]\n" +
                                  "iterations = 1\n" + kBody);
  EXPECT_EQ(scene.settings.iterations, 1);
  const std::string severity =
      "[severity]\nset = \"simulation.substeps\"\nfrom = 64\nto = 1\nlabel = \"n\"\n";
  EXPECT_EQ(
      caseSceneOf(kCaseHead + severity + "[simulation]\nsubsteps = 7\n" + kBody).settings.substeps,
      7);
}

TEST(StabilityCase, TellsAMistakeAtItsPlace) {
  EXPECT_EQ(caseErrorOf("[stability]\nfamily = \"chain\"\nabout = \"\"\n" + kBody),
            "case.toml:2:10: stability.family: no family 'chain' in stability_families.toml; did "
            "you mean 'chains'?");
  EXPECT_EQ(caseErrorOf(kCaseHead + "famly = 1\n" + kBody),
            "case.toml:5:1: stability: unknown key 'famly'; did you mean 'family'?");
  EXPECT_TRUE(caseErrorOf(kSeverity + kBody)
                  .starts_with("case.toml:1:2: unknown table 'severity'; expected title, "));
  EXPECT_EQ(caseErrorOf(kCaseHead + kBody + kSeverity + "scale = \"lg\"\n").substr(0, 20),
            "case.toml:15:9: seve");
  EXPECT_EQ(caseErrorOf(kCaseHead + kBody, {"simulation.substeps=0"}),
            "--set simulation.substeps=0: simulation.substeps: expected an integer in [1, 1000000]"
            ", got 0");
}

TEST(StabilityCase, TellsAMistakeInTheSeverityAtItsPlace) {
  const auto error = [](const std::string& text) -> std::string {
    try {
      casesOf(kCaseHead + kBody + text);
    } catch (const InputError& problem) {
      const std::string what = problem.what();
      return what.substr(what.find(".toml"));
    }
    return "no error";
  };
  const std::string tail = "from = 1\nto = 1000\nlabel = \"m\"\n";
  EXPECT_EQ(error("[severity]\nset = \"body.q.mass\"\n" + tail),
            ".toml:11:7: severity.set: expected a number at 'body.q.mass' in this file or its "
            "family");
  EXPECT_EQ(error("[severity]\nset = \"body.p.mass\"\nfrom = 10\nto = 100\nlabel = \"m\"\n"),
            ".toml:11:7: severity.set: expected the stated level between 'from' and 'to', got "
            "body.p.mass = 3");
  EXPECT_EQ(error("[severity]\nset = \"body.p.mass\"\nfrom = -1\nto = 100\nlabel = \"m\"\n"),
            ".toml:12:8: severity.from: expected 'from' and 'to' of the same sign for the scale "
            "'log'");
}

TEST(StabilityCase, StatesTheLevelThatTheFileSays) {
  const std::vector<StabilityCase> cases = casesOf(kCaseHead + kBody + kSeverity);
  ASSERT_EQ(cases.size(), 1u);
  const StabilitySeverity& severity = cases[0].severity.value();
  EXPECT_EQ(severity.stated, 3);
  EXPECT_DOUBLE_EQ(severity.placeOf(1), 0);
  EXPECT_DOUBLE_EQ(severity.placeOf(10), 1.0 / 3);
  EXPECT_EQ(severity.levelAt(2.0 / 3), 100);
  EXPECT_EQ(severity.overrides(100), (std::vector<std::string>{"body.p.mass=100"}));
}

TEST(StabilitySeverity, TellsLevelsOfANarrowRangeApart) {
  StabilitySeverity severity;
  severity.from = 0.5;
  severity.to = 0.4999;
  for (const auto scale : {StabilitySeverity::Scale::kLinear, StabilitySeverity::Scale::kLog}) {
    severity.scale = scale;
    EXPECT_NEAR(severity.levelAt(0.5), 0.49995, 1e-7);
    EXPECT_NEAR(severity.placeOf(severity.levelAt(0.3)), 0.3, 0.01);
  }
}

TEST(StabilityCase, OfAVariantHasItsOverridesAndItsOwnExpectations) {
  const std::vector<StabilityCase> cases = casesOf(kCaseHead + kBody + kExpect + kVariant);
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[1].name, cases[0].name + ".fast");
  const Scene scene =
      caseSceneOf(kCaseHead + kBody + kExpect + kVariant, {"stability.variant=fast"});
  ASSERT_EQ(scene.expectations.size(), 1u);
  EXPECT_EQ(scene.expectations[0].atLeast, -1);
  EXPECT_EQ(Simulation(scene).world().bodies().velocity[1].v.x(), 9);
  EXPECT_EQ(caseErrorOf(kCaseHead + kBody + kVariant, {"stability.variant=fats"}),
            "--set stability.variant=fats: no such [[variant]]; did you mean 'fast'?");
  EXPECT_EQ(casesOf(kCaseHead + kBody + kExpect + kVariant, ".fast").size(), 1u);
}

TEST(StabilityCase, EveryFileOfTheCatalogueIsRead) {
  for (const std::string& file : stabilityFiles()) {
    EXPECT_NO_THROW({
      for (const StabilityCase& study : readStabilityCases(file)) {
        EXPECT_FALSE(study.about.empty()) << file;
      }
    }) << file;
  }
  EXPECT_FALSE(stabilityFiles().empty());
}

}  // namespace
}  // namespace scenes
