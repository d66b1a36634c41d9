// The shipped cases of the accuracy study: all read, all begin where their references do, all run.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "scenes/study/study_case.h"
#include "scenes/study/study_files.h"
#include "scenes/study/study_trace.h"

namespace scenes {
namespace {

// Runs the case's scene over `samples` after the start.
StudyTrace traced(const StudyCase& study, std::span<const std::string> more, int samples) {
  Simulation simulation(studyScene(study, more));
  StudyTracer tracer(study, simulation);
  tracer.observe(simulation);
  for (int k = 0; k < samples && simulation.isFinite(); ++k) {
    simulation.advance();
    tracer.observe(simulation);
  }
  EXPECT_TRUE(simulation.isFinite());
  return tracer.trace();
}

class EveryCase : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, EveryCase, testing::ValuesIn(studyCases()), [](const auto& info) {
  return std::filesystem::path(info.param).stem().string();
});

TEST_P(EveryCase, RunsForThreeSamples) {
  const StudyCase study = readStudyCase(GetParam());
  EXPECT_FALSE(study.title.empty());
  EXPECT_FALSE(study.about.empty());
  EXPECT_EQ(traced(study, {}, 3).samples, 4);
}

// Positions and velocities of the start; a table has fifteen digits.
TEST_P(EveryCase, BeginsWhereItsReferenceDoes) {
  const StudyCase study = readStudyCase(GetParam());
  const StudyTrace trace = traced(study, {}, 0), truth = truthOf(study, nullptr);
  for (std::size_t k = 0; k < study.quantities.size(); ++k) {
    const StudyQuantity& quantity = study.quantities[k];
    const bool isLaterOnly = quantity.from.value_or(0) > 0;
    if (quantity.over != StudyQuantity::Over::kEach || isLaterOnly) continue;
    const std::vector<double>& begun = trace.quantities[k].at(0);
    const std::vector<double>& wanted = truth.quantities[k].at(0);
    ASSERT_FALSE(wanted.empty()) << quantity.metric;
    for (std::size_t at = 0; at < begun.size(); at += wanted.size()) {
      EXPECT_LT(distance(quantity, begun.data() + at, wanted.data()), 1e-9) << quantity.metric;
    }
  }
}

// Halving the step halves the error: the paper's steps are of first order.
TEST(Pendulum, ByThePapersStepsConvergesAtFirstOrderToItsTable) {
  StudyCase study = readStudyCase("pendulum");
  study.duration = 2;
  const StudyTrace truth = truthOf(study, nullptr);
  double last = 0;
  for (const int substeps : {200, 400, 800}) {
    const std::vector<std::string> set{"simulation.method=direct", "simulation.stepping=paper",
                                       "simulation.substeps=" + std::to_string(substeps)};
    const StudyTrace trace = traced(study, set, study.sampleCount() - 1);
    const double error = compare(study, trace, truth).error;
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / error), 1, 0.06);  // measured 0.98
    }
    last = error;
  }
  EXPECT_LT(last, 0.02);
}

}  // namespace
}  // namespace scenes
