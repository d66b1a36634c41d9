// Measuring the cases of `dbd study accuracy`, and going on where it was interrupted.
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "app/base/progress.h"
#include "app/study/study_plan.h"
#include "app/study/study_point.h"
#include "app/study/study_run.h"

namespace app {

struct StudyEnds {  // how measuring a case ended
  bool interrupted = false;
  std::string problem;  // why its reference cannot be had
};

class AccuracyStudy {
 public:
  // `keep`: points.csv of the folder is read, and what is in it from the same inputs is not
  // measured again.
  AccuracyStudy(std::vector<scenes::StudyCase> cases, const std::filesystem::path& folder,
                bool quick, bool keep, ProgressMode progress);

  int caseCount() const { return static_cast<int>(cases_.size()); }
  // Measures what is missing of a case.
  StudyEnds measure(int index);
  // The table in the order of the plan, whatever was measured when; rows of other cases first.
  void finish();
  const StudyResults& results(int index) const { return results_[static_cast<std::size_t>(index)]; }
  int reusedPoints() const { return reused_; }

 private:
  struct Inputs {  // hashes of all that numbers depend on, this program among it
    std::string reference;
    std::vector<std::string> methods;  // of the case
  };
  static Inputs inputsOf(const scenes::StudyCase& study);
  std::optional<StudyPoint> pointFor(const PlannedPoint& planned, StudyResults& results,
                                     const scenes::StudyTrace& truth, const std::string& inputs);
  StudyEnds measurePoints(std::size_t index, const scenes::StudyTrace& truth);
  double workOf(std::size_t index, const PlannedPoint& planned) const;

  std::vector<scenes::StudyCase> cases_;
  std::filesystem::path folder_;
  bool quick_;
  StudyEffort effort_;
  PointStore store_;
  std::vector<Inputs> inputs_;                    // per case
  std::vector<std::vector<PlannedPoint>> plans_;  // per case
  std::vector<StudyResults> results_;
  std::optional<Progress> progress_;
  int reused_ = 0;
};

}  // namespace app
