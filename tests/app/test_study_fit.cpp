// Orders, fronts and verdicts of points made by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "app/study/accuracy.h"
#include "app/study/asked.h"
#include "app/study/cheapest.h"
#include "app/study/fit.h"
#include "app/study/store.h"

namespace app {
namespace {

std::vector<StepError> errorsOf(double order, double factor, int count) {
  std::vector<StepError> points;
  for (int i = 0; i < count; ++i) {
    const double h = std::pow(0.5, i);
    points.push_back({h, factor * std::pow(h, order)});
  }
  return points;
}

TEST(FitOrder, FindsTheOrderOfAPowerExactly) {
  for (const double order : {1.0, 2.0, 4.0}) {
    const auto fit = fitOrder(errorsOf(order, 0.1, 6), 0, 1);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->order, order, 1e-12);
    EXPECT_NEAR(fit->deviation, 0, 1e-7);
    EXPECT_EQ(fit->points, 5);  // the finest
  }
}

TEST(FitOrder, LeavesOutWhatDoesNotConvergeYetAndTheFloor) {
  std::vector<StepError> points = errorsOf(2, 0.1, 6);
  points.push_back({2, 0.05});     // coarser, and better by luck
  points.push_back({1e-3, 1e-4});  // round-off: finer, and no better
  points.push_back({1e-4, 1.1e-4});
  const auto fit = fitOrder(points, 0, 1);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->points, 5);
  EXPECT_NEAR(fit->order, 2, 1e-12);
}

TEST(FitOrder, KeepsToErrorsBetweenFloorAndCeiling) {
  const auto fit = fitOrder(errorsOf(1, 1, 8), 0.03, 0.3);  // 1/4, 1/8, 1/16, 1/32
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->points, 4);
  EXPECT_DOUBLE_EQ(fit->coarsest, 0.25);
}

TEST(FitOrder, SaysNothingOfTwoPointsOrOfNone) {
  EXPECT_FALSE(fitOrder(errorsOf(2, 1, 2), 0, 10));
  EXPECT_FALSE(fitOrder({}, 0, 1));
  EXPECT_FALSE(fitOrder({{1, 0}, {0.5, 0}, {0.25, 0}, {0.125, 0}}, 0, 1));  // exact
  EXPECT_FALSE(fitOrder({{1, NAN}, {0.5, NAN}, {0.25, INFINITY}}, 0, 1));
}

Trace pointOf(double wall, double error, Trace::Status status = Trace::Status::kOk) {
  Trace point;
  point.wall = wall;
  point.errors.error = error;
  point.status = status;
  return point;
}

TEST(Front, KeepsWhatNoOtherPointBeats) {
  const Trace cheap = pointOf(1, 1), good = pointOf(3, 0.1), beaten = pointOf(4, 0.2),
              exploded = pointOf(0.5, 0.01, Trace::Status::kExploded);
  const std::vector<const Trace*> points{&beaten, &good, &exploded, &cheap};
  EXPECT_EQ(front(points), (std::vector<const Trace*>{&cheap, &good}));
  EXPECT_EQ(cheapest(points, 0.2), &good);
  EXPECT_EQ(cheapest(points, 0.05), nullptr);
}

scenes::StudyMethod methodOf(const std::string& name, const std::string& peer, bool asks) {
  scenes::StudyMethod method;
  method.name = name;
  method.peer = peer;
  method.asks = asks;
  return method;
}

Trace askedPointOf(double asked, double error) {
  Trace point = pointOf(1e-3, error);
  point.key = {"case", "asked", 1, 1, 0, asked};
  return point;
}

// A case of scale 2 with a method of ours that is asked, and a peer.
CaseResults resultsOf(double reference, const std::vector<Trace>& points) {
  CaseResults results;
  results.study.name = "case";
  results.study.scale = 2;
  results.study.methods = {methodOf("asked", "", true), methodOf("peer", "bullet", false)};
  results.study.grids.resize(2);
  results.study.grids[0].accuracies = {1e-6, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
  results.reference.accuracy = reference;
  results.points = points;
  return results;
}

TEST(Asked, ThreeTimesWhatWasAskedIsStillDelivered) {
  const CaseResults results =
      resultsOf(1e-5, {askedPointOf(1e-1, 1e-3), askedPointOf(1e-2, 0.06),
                       askedPointOf(1e-3, 0.0061), askedPointOf(1e-6, 1e-4)});
  const std::vector<AskedPoint> asked = askedPoints({&results});
  ASSERT_EQ(asked.size(), 4u);
  EXPECT_EQ(asked[0].verdict, AskedPoint::Verdict::kDelivered);
  EXPECT_EQ(asked[1].verdict, AskedPoint::Verdict::kDelivered);
  EXPECT_EQ(asked[2].verdict, AskedPoint::Verdict::kBeyond);
  EXPECT_EQ(asked[3].verdict, AskedPoint::Verdict::kUnjudged);  // the reference is off by 5e-6
  EXPECT_EQ(askedText(asked),
            "2 of 3 points (67 %) are within 3 times the accuracy that they were asked for; of 1 "
            "more the reference is no better than what was asked");
}

TEST(Asked, CostsAreComparedWithSettingsChosenByHandThatDeliverTheSame) {
  Trace coarse = pointOf(1e-3, 0.1), fine = pointOf(2e-3, 1e-3);  // of a scale of 2
  coarse.key = fine.key = {"case", "asked"};                      // by no accuracy: by hand
  Trace cheap = askedPointOf(1e-1, 1e-3), dear = askedPointOf(1e-2, 1e-3);
  cheap.wall = 1.2e-3;
  dear.wall = 4e-3;
  const CaseResults results = resultsOf(0, {cheap, dear, askedPointOf(1e-4, 1e-4), coarse, fine});
  const std::vector<AskedPoint> asked = askedPoints({&results});
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_DOUBLE_EQ(asked[0].overByHand, 1.2);  // the coarse one is good for 1e-1
  EXPECT_DOUBLE_EQ(asked[1].overByHand, 2);    // but not for 1e-2
  EXPECT_EQ(asked[2].overByHand, 0);           // and none for 1e-4
  EXPECT_EQ(askedText(asked),
            "3 of 3 points (100 %) are within 3 times the accuracy that they were asked for. Of "
            "those whose case measures the motion, settings of ours chosen by hand deliver 2 as "
            "well; 1 cost at most 1.5 times the cheapest of those, 1 more: case (2)");
  CaseResults gaps = results;
  gaps.study.quantities.resize(1);
  gaps.study.quantities[0].metric = "joint_error";
  EXPECT_EQ(askedPoints({&gaps})[1].overByHand, 0);
}

TEST(Asked, WhatFailedWasNotDelivered) {
  Trace point = askedPointOf(1e-1, 0);
  point.status = Trace::Status::kNotFinite;
  const CaseResults results = resultsOf(0, {point});
  EXPECT_EQ(askedPoints({&results})[0].verdict, AskedPoint::Verdict::kBeyond);
}

TEST(Asked, CountsAsOursAtTheGoals) {
  Trace peer = pointOf(1e-4, 0.01);  // cheaper, and good for 1 % of 2
  peer.key = {"case", "peer"};
  const CaseResults results = resultsOf(0, {askedPointOf(1e-3, 1e-4), peer});
  EXPECT_EQ(
      goalsText({&results}),
      "ours is the cheapest, or alone, at 1 of 2 goals: 1 % and 0.1 % of 1 cases; at 1 by what "
      "is asked of it alone, without a choice of steps");
}

TEST(Asked, APlanHasTheCoarsestFirstAndThreeWhereItIsQuick) {
  const auto accuracies = [](bool quick) {
    std::vector<double> result;
    for (const PlannedPoint& planned : planPoints(resultsOf(0, {}).study, quick)) {
      if (planned.method == 0) result.push_back(planned.key.accuracy);
    }
    return result;
  };
  EXPECT_EQ(accuracies(false), (std::vector<double>{1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}));
  EXPECT_EQ(accuracies(true), (std::vector<double>{1e-1, 1e-3, 1e-6}));
}

TEST(Asked, AnAccuracyReadsAsItIsWritten) {
  EXPECT_EQ(accuracyText(1e-1), "1e-1");
  EXPECT_EQ(accuracyText(1e-3), "1e-3");
  EXPECT_EQ(accuracyText(2.5e-6), "2.5e-6");
  EXPECT_EQ(askedPointOf(1e-6, 0).key.text(), "accuracy 1e-6");
}

TEST(Store, ALineComesBackAsItWas) {
  Trace trace = pointOf(1.25e-3, 3.5e-7, Trace::Status::kExploded);
  trace.key = {"pendulum", "bdf2", 2, 16, 4, 1e-3, "0.5"};
  trace.message = "error 12 m, at the end\nof it";
  trace.errors.last = INFINITY;
  trace.failure = TraceFailure{3, 0.1, "overlap 1 m", "a, b", "contact"};
  trace.verdicts.push_back({"overlap", "overlap 1 m <= 0.1 m", false, true, 1, 0.1, 0.1, 12});
  trace.samples = {{{1.0, 2.0}, {}}, {{0.1}}};
  const Trace back = parseTrace(lineOf(trace));
  EXPECT_EQ(back.key, trace.key);
  EXPECT_EQ(back.samples, trace.samples);
  EXPECT_EQ(back.failure->where(), "a, b, contact");
  EXPECT_EQ(lineOf(back), lineOf(trace));
  EXPECT_EQ(pointsTable({back}), pointsTable({trace}));
  EXPECT_ANY_THROW(parseTrace(lineOf(trace).substr(0, 40)));
  EXPECT_ANY_THROW(parseTrace("{}"));
}

// Two cases: 1 and 2 ms at 1e-1, 4 and 8 at 1e-3: twice as much for each decade.
TEST(Glance, SaysWhatTenTimesTheAccuracyCosts) {
  std::vector<CaseResults> cases;
  for (const double times : {1.0, 2.0}) {
    Trace coarse = askedPointOf(1e-1, 1e-3), fine = askedPointOf(1e-3, 1e-4);
    coarse.wall = 1e-3 * times;
    fine.wall = 4e-3 * times;
    cases.push_back(resultsOf(0, {fine, coarse}));
    cases.back().study.scenePath = "pendulum";
  }
  const Glance glance = glanceAt({&cases[0], &cases[1]});
  ASSERT_EQ(glance.sentences.size(), 1u);
  EXPECT_EQ(glance.sentences[0],
            "joints (2 cases): ten times more accurate costs 2 times more; 1.41 ms for a simulated "
            "second at 1e-1, 5.66 ms at 1e-3; 4 of 4 were delivered; no other engine is as good.");
  ASSERT_TRUE(glance.chart);
  EXPECT_EQ(glance.chart->series.size(), 1u);
}

}  // namespace
}  // namespace app
