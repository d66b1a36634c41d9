// Errors of studies, from traces made by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/read/reference_table.h"
#include "scenes/study/study_trace.h"

namespace scenes {
namespace {

// Three samples a second for one second, one quantity.
StudyCase caseMeasuring(const std::string& metric) {
  StudyCase study;
  study.duration = 1;
  study.fps = 3;
  StudyQuantity quantity;
  quantity.metric = metric;
  study.quantities = {quantity};
  return study;
}

StudyTrace traceOf(QuantitySamples samples) {
  StudyTrace trace;
  trace.samples = static_cast<int>(samples.size());
  trace.quantities = {std::move(samples)};
  return trace;
}

TEST(StudyErrors, TheLargestIsTakenOverTheTrustedTime) {
  StudyCase study = caseMeasuring("max_speed");
  study.quantities[0].law = {1, 3};  // 1 + 3 t: 1, 2, 3, 4 at the samples
  const StudyTrace truth = truthOf(study, nullptr);
  const StudyTrace trace = traceOf({{1}, {2.5}, {3}, {9}});
  EXPECT_DOUBLE_EQ(compare(study, trace, truth).error, 5);
  study.trustedUntil = 0.7;
  EXPECT_NEAR(compare(study, trace, truth).error, 0.5, 1e-15);
  EXPECT_EQ(compare(study, trace, truth).compared, 3);
}

TEST(StudyErrors, MeansAreOverSamplesAndBodies) {
  StudyCase study = caseMeasuring("x");
  study.error = StudyCase::Error::kMeanSquare;
  const StudyTrace truth = truthOf(study, nullptr);  // zero
  const StudyTrace trace = traceOf({{0, 0}, {1, 3}, {0, 0}, {1, 1}});
  EXPECT_NEAR(compare(study, trace, truth).error, (0 + 5.0 + 0 + 1) / 4, 1e-14);
}

TEST(StudyErrors, ANumberOverTheRunIsComparedOnce) {
  StudyCase study = caseMeasuring("max_speed");
  study.quantities[0].over = StudyQuantity::Over::kMax;
  study.quantities[0].law = {2};
  EXPECT_DOUBLE_EQ(compare(study, traceOf({{0}, {5}, {1}, {0}}), truthOf(study, nullptr)).error, 3);
}

TEST(StudyErrors, OppositeQuaternionsAreTheSameOrientation) {
  StudyCase study = caseMeasuring("orientation");
  study.quantities[0].body.assign(1, 'b');
  const double a = 0.5e-9;  // half an angle too small for acos
  const QuantitySamples samples(4, {-std::cos(a), -std::sin(a), 0, 0});
  const StudyTrace self = traceOf(QuantitySamples(4, {1, 0, 0, 0}));
  EXPECT_NEAR(compare(study, traceOf(samples), truthOf(study, &self)).error, 1e-9, 1e-20);
}

TEST(StudyErrors, NotANumberIsTheWorst) {
  const StudyCase study = caseMeasuring("max_speed");
  const StudyTrace trace = traceOf({{0}, {NAN}, {1}, {0}});
  EXPECT_TRUE(std::isnan(compare(study, trace, truthOf(study, nullptr)).error));
}

TEST(ReferenceTable, SkipsRemarksAndTellsATornRow) {
  const ReferenceTable table = parseReferenceTable("# m = 1\nt,x\n0,1\n0.5,nan\n", "t.csv");
  EXPECT_EQ(table.column("x"), 1);
  EXPECT_EQ(rowAt(table, 0, 0.5), 1);
  EXPECT_EQ(rowAt(table, 0, 0.25), -1);
  EXPECT_TRUE(std::isnan(table.rows[1][1]));
  EXPECT_THROW(parseReferenceTable("t,x\n0\n", "t.csv"), InputError);
}

}  // namespace
}  // namespace scenes
