// Cases of studies: what they say is read, and what is wrong in them is told at its place.
#include <gtest/gtest.h>

#include "scenes/study/study_case.h"

namespace scenes {
namespace {

const std::string kStudyHead = "title = \"t\"\nscene = \"pendulum\"\nduration = 1\nfps = 10\n";
const std::string kBob = "[[quantity]]\nmetric = \"x\"\nbody = \"bob\"\n";
const std::string kTable = "[reference]\ntable = \"S01_pendulum_A01.csv\"\n";
const std::string kSweep = "[sweep]\nmethods = [\"paper\"]\nsubsteps = [1, 2]\n";

StudyCase caseOf(const std::string& text) { return parseStudyCase(text, "case.toml"); }

std::string studyErrorOf(const std::string& text) {
  try {
    caseOf(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(StudyCase, ReadsWhatIsSweptForEachMethod) {
  const StudyCase study = caseOf(kStudyHead + kBob +
                                 "[sweep]\nmethods = [\"paper\", \"bdf2\"]\nsubsteps = [1, 4]\n"
                                 "iterations = [3]\n[sweep.bdf2]\nsubsteps = [7]\n");
  EXPECT_EQ(study.grids[0].substeps, (std::vector<int>{1, 4}));
  EXPECT_EQ(study.grids[0].iterations, (std::vector<int>{3}));
  EXPECT_EQ(study.grids[1].substeps, (std::vector<int>{7}));
  EXPECT_EQ(study.grids[1].iterations, (std::vector<int>{0}));  // it does not iterate
  EXPECT_EQ(study.sampleCount(), 11);
}

TEST(StudyCase, AMethodThatIsAskedIsSweptOverAccuraciesAlone) {
  const std::string sweep =
      "[sweep]\nmethods = [\"paper\", \"accuracy\"]\nsteps = [2]\nsubsteps = [1, 4]\n";
  const StudyCase study = caseOf(kStudyHead + kBob + sweep);
  EXPECT_EQ(study.grids[0].accuracies, (std::vector<double>{0}));
  EXPECT_EQ(study.grids[1].accuracies, (std::vector<double>{1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}));
  EXPECT_EQ(study.grids[1].steps, (std::vector<int>{1}));
  EXPECT_EQ(study.grids[1].substeps, (std::vector<int>{1}));
  const StudyCase own = caseOf(kStudyHead + kBob + sweep + "accuracies = [1e-3]\n");
  EXPECT_EQ(own.grids[1].accuracies, (std::vector<double>{1e-3}));
}

TEST(StudyCase, StepsAndAccuraciesAreNotMixed) {
  const std::string head = kStudyHead + kBob + "[sweep]\nmethods = [\"paper\", \"accuracy\"]\n";
  EXPECT_EQ(studyErrorOf(head + "[sweep.accuracy]\nsubsteps = [2]\n"),
            "case.toml:11:12: accuracy.substeps: 'accuracy' is swept over accuracies alone");
  EXPECT_EQ(studyErrorOf(head + "[sweep.paper]\naccuracies = [1e-2]\n"),
            "case.toml:11:14: paper.accuracies: 'paper' is not asked for an accuracy");
}

TEST(StudyCase, NamesTheNearestKeyForAnUnknownOne) {
  EXPECT_EQ(studyErrorOf(kStudyHead + kBob + "colum = \"x\"\n" + kSweep),
            "case.toml:8:1: quantity: unknown key 'colum'; did you mean 'column'?");
  EXPECT_EQ(studyErrorOf(kStudyHead + "quik = true\n" + kBob + kSweep),
            "case.toml:5:1: unknown key 'quik'; did you mean 'quick'?");
}

TEST(StudyCase, NamesTheNearestMethodMetricBodyAndColumn) {
  EXPECT_EQ(studyErrorOf(kStudyHead + kBob + "[sweep]\nmethods = [\"papr\"]\n"),
            "case.toml:9:11: sweep.methods: no method 'papr'; did you mean 'paper'?");
  EXPECT_EQ(
      studyErrorOf(kStudyHead + "[[quantity]]\nmetric = \"orientaton\"\nbody = \"bob\"\n" + kSweep),
      "case.toml:6:10: quantity.metric: unknown metric 'orientaton'; did you mean "
      "'orientation'?");
  EXPECT_EQ(studyErrorOf(kStudyHead + kTable + kBob + "column = \"xx\"\n" + kSweep),
            "case.toml:10:10: quantity.column: the reference's table has no column 'xx'; did you "
            "mean 'x'?");
  const std::string error =
      studyErrorOf(kStudyHead + "[[quantity]]\nmetric = \"x\"\nbody = \"bib\"\n" + kSweep);
  EXPECT_EQ(error.substr(0, 44), "case.toml:7:8: quantity.body: no body 'bib' ") << error;
}

TEST(StudyCase, AReferenceRunMustBeTenTimesFiner) {
  const std::string self = "[reference]\nself = { substeps = 18 }\n";
  EXPECT_EQ(studyErrorOf(kStudyHead + self + kBob + kSweep),
            "case.toml:5:1: .reference: self: expected steps * substeps >= 20, 10 times those of "
            "the finest point, got 18");
}

TEST(StudyCase, VectorsWantAColumnForEachComponent) {
  EXPECT_EQ(
      studyErrorOf(kStudyHead + kTable +
                   "[[quantity]]\nmetric = \"position\"\nbody = \"bob\"\ncolumns = [\"x\"]\n" +
                   kSweep),
      "case.toml:10:11: quantity.columns: expected 3 columns for position, got 1");
}

TEST(StudyCase, EveryShippedCaseIsRead) {
  const std::vector<std::string> cases = studyCases();
  EXPECT_FALSE(cases.empty());
  for (const std::string& path : cases) {
    const StudyCase study = readStudyCase(path);
    EXPECT_FALSE(study.about.empty()) << path << ": say what the case shows";
  }
}

}  // namespace
}  // namespace scenes
