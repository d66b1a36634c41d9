// The loop over cases, methods and levels of `dbd study stability`, and going on where it was
// interrupted.
#pragma once

#include <filesystem>

#include "app/base/progress.h"
#include "app/study/severity_search.h"
#include "app/study/stability_shot.h"

namespace app {

// A way to solve a case: as its family does, or by a method of scenes/studies/methods.toml.
struct StabilityWay {
  std::string method;  // empty: the family's own settings
  std::string title, color;
  std::vector<std::string> set;
};
// The family's own way first; methods that are the same are left out.
std::vector<StabilityWay> waysOf(const scenes::StabilityCase& study);

// The overrides of a run at a level of severity.
std::vector<std::string> overridesOf(const StabilityWay& way,
                                     const scenes::StabilitySeverity& severity, double level);

// How far a case can be pushed in one way.
struct StabilityBar {
  StabilityWay way;
  SeverityBorder border;
  bool isSpent = false;                      // stopped: the search had cost all it may
  std::optional<StabilityRun> firstFailure;  // the run at border.fails
  std::vector<StabilityShot> shots;          // of that run
};

struct StabilityResult {
  scenes::StabilityCase study;
  std::string problem;  // why the case could not be read
  StabilityRun stated;
  std::vector<StabilityShot> shots;         // its end
  std::vector<StabilityShot> failureShots;  // where it fails
  std::vector<StabilityBar> bars;

  bool holds() const { return problem.empty() && stated.holds(); }
};

// The command that draws what fails in a run, with the frames around it.
std::string reproduction(const scenes::StabilityCase& study, const std::vector<std::string>& set,
                         const StabilityRun& run);

class StabilityStudy {
 public:
  // `keep`: what runs.jsonl of the folder holds from the same inputs is not run again.
  StabilityStudy(std::vector<StabilityResult> cases, std::filesystem::path folder, bool keep,
                 int threads, ProgressMode progress);

  // False: interrupted. `done` is told of each case, one at a time.
  bool judge(const std::function<void(const StabilityResult&)>& done);
  bool search();
  bool draw();  // pictures of what failed

  const std::vector<StabilityResult>& results() const { return results_; }
  int reusedRuns() const { return reused_; }

 private:
  std::optional<StabilityRun> runOf(const StabilityResult& result, const StabilityKey& key,
                                    const std::vector<std::string>& set,
                                    const StabilityLimits& limits, const StabilityVisit& visit);
  bool runLongestFirst(const std::string& stage, const std::vector<double>& work,
                       const std::function<bool(std::size_t)>& task);
  bool judgeCase(StabilityResult& result);
  bool searchBar(const StabilityResult& result, StabilityBar& bar);
  std::string inputsOf(const StabilityResult& result, const std::vector<std::string>& set) const;
  double secondsBefore(const StabilityKey& key) const;

  std::vector<StabilityResult> results_;
  std::filesystem::path folder_;
  StabilityStore store_;
  int threads_;
  ProgressMode progress_;
  std::mutex mutex_;  // of what the tasks share
  int reused_ = 0;
};

}  // namespace app
