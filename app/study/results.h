// Which runs a case of the accuracy study consists of, and what is known of them together.
#pragma once

#include <optional>
#include <vector>

#include "app/study/fit.h"
#include "scenes/study/study_case.h"

namespace app {

struct PlannedPoint {
  int method = 0;  // of the case
  RunKey key;
};

// In the order of measuring: method by method, iterations by iterations, the coarsest first.
// `quick`: at most four substeps, two iterations and two numbers of steps, three accuracies.
std::vector<PlannedPoint> planPoints(const scenes::StudyCase& study, bool quick);

struct CaseReference {
  std::string what;                // "table S01_pendulum_A01.csv", "own run at h = ..."
  std::optional<double> accuracy;  // estimated error, in the unit of the case's error
};

// A case with all that was measured of it.
struct CaseResults {
  scenes::StudyCase study;
  CaseReference reference;
  std::vector<Trace> points;  // in the order of the plan
  std::string problem;        // why it has none

  std::vector<const Trace*> of(int method) const;  // its points
  std::vector<const Trace*> ours() const;          // of all methods that are not peers
  std::vector<const Trace*> peers() const;
  bool hasSteps() const;       // a point that is ok has a step of its own
  const Trace* best() const;   // the smallest error; null: nothing is ok
  const Trace* worst() const;  // the largest error that is still ok
  int methodOf(const Trace& point) const;
  std::string methodTitle(const Trace& point) const;
  std::string titleOf(int method) const;

  // Of the points with as many iterations as the best of them has; none: it does not converge.
  // A mean square counts with its root.
  std::optional<OrderFit> order(int method) const;
  double relative(double error) const;  // to the scale; a mean square counts with its root
  bool wasBusy() const;  // other programs took part of the machine while it was measured
};

}  // namespace app
