// Which points a case consists of, and what is known of them together.
#pragma once

#include <optional>
#include <vector>

#include "app/study/study_fit.h"
#include "scenes/study/study_case.h"

namespace app {

struct PlannedPoint {
  int method = 0;  // of the case
  StudyKey key;
};

// In the order of measuring: method by method, iterations by iterations, the coarsest first.
// `quick`: at most four substeps, two iterations and two numbers of steps, three accuracies.
std::vector<PlannedPoint> planPoints(const scenes::StudyCase& study, bool quick);

struct StudyReferenceReport {
  std::string what;                // "table S01_pendulum_A01.csv", "own run at h = ..."
  std::optional<double> accuracy;  // estimated error, in the unit of the case's error
  double seconds = 0;              // that the reference runs took
};

// A case with all that was measured of it.
struct StudyResults {
  scenes::StudyCase study;
  StudyReferenceReport reference;
  std::vector<StudyPoint> points;  // in the order of the plan

  std::vector<const StudyPoint*> of(int method) const;  // its points
  std::vector<const StudyPoint*> ours() const;          // of all methods that are not peers
  std::vector<const StudyPoint*> peers() const;
  bool hasSteps() const;            // a point that is ok has a step of its own
  const StudyPoint* best() const;   // the smallest error; null: nothing is ok
  const StudyPoint* worst() const;  // the largest error that is still ok
  int methodOf(const StudyPoint& point) const;
  std::string methodTitle(const StudyPoint& point) const;

  // Of the points with as many iterations as the best of them has; none: it does not converge.
  // A mean square counts with its root.
  std::optional<OrderFit> order(int method) const;
  bool wasBusy() const;  // other programs took part of the machine while it was measured
};

}  // namespace app
