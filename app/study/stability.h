// Hard cases: whether they hold, and how far each can be pushed by which method.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/study/report.h"
#include "app/study/run.h"
#include "app/study/severity_search.h"
#include "app/study/study.h"
#include "scenes/study/stability_case.h"

namespace app {

constexpr int kBoundsEvery = 10;  // frames, of those that frame a picture

struct StabilityShot {
  std::string file;  // name in the output folder
  std::string caption;
  int frame = 0;
  bool isClose = false;  // only the bodies that failed
};

// A way to solve a case: as its family does, or by a method of scenes/studies/methods.toml.
struct StabilityWay {
  std::string method;  // empty: the family's own settings
  std::string title, color;
  std::vector<std::string> set;
};
// The family's own way first; methods that are the same are left out.
std::vector<StabilityWay> waysOf(const scenes::StabilityCase& study);

// How far a case can be pushed in one way.
struct StabilityBar {
  StabilityWay way;
  SeverityBorder border;
  bool isSpent = false;               // stopped: the search had cost all it may
  std::optional<Trace> firstFailure;  // the run at border.fails
  std::vector<StabilityShot> shots;   // of that run
};

struct StabilityResult {
  scenes::StabilityCase study;
  std::string problem;  // why the case could not be read
  std::optional<Trace> stated;
  std::vector<StabilityShot> shots;         // its end
  std::vector<StabilityShot> failureShots;  // where it fails
  std::vector<StabilityBar> bars;

  bool holds() const { return stated && stated->isOk(); }
};

// The overrides of a run at a level of severity.
std::vector<std::string> overridesOf(const StabilityWay& way,
                                     const scenes::StabilitySeverity& severity, double level);

// A run with overrides beside the case's own; where there are any, an expectation whose span was
// cut off is not held against it. None: interrupted.
struct StabilityVisit {
  // Shows every frame; `failed`: an expectation has failed by now.
  std::function<void(const scenes::Simulation& simulation, bool failed)> show;
  bool stopsAtFailure = false;  // no later frame can mend it
};
std::optional<Trace> judge(const Run& run, bool isLenient, const StabilityVisit& visit);
Run runOf(const scenes::StabilityCase& study, const std::vector<std::string>& set);

// The frames before, at and after a failure, as far as they exist, and the bodies where it failed.
std::vector<StabilityShot> planFailureShots(const Trace& trace);
// Runs again and draws those whose file is not there. False: interrupted.
bool drawFailureShots(const Run& run, const Trace& trace, const std::vector<StabilityShot>& shots,
                      const std::filesystem::path& folder);

// "holds", or how it does not.
std::string stabilityWord(const Trace& trace);
// The command that draws what fails in a run, with the frames around it.
std::string reproduction(const scenes::StabilityCase& study, const std::vector<std::string>& set,
                         const Trace& trace);
// "at 3.7e5: joint_error, ball_socket 19, frame 34"
std::string borderText(const StabilityBar& bar);
// How far each case of a family can be pushed, a bar for each method. None: nothing was searched.
std::optional<Chart> mapOf(const std::vector<const StabilityResult*>& cases,
                           const std::string& title, const std::string& name);

std::string verdictText(const StabilityResult& result);   // for standard output
std::string severityText(const StabilityResult& result);  // its borders; empty: not looked for
StudyFindings stabilityFindings(const std::vector<StabilityResult>& results, bool searched,
                                const std::string& command, int reused);

}  // namespace app
