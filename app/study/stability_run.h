// One run of a case of the stability study: what it was, whether its criterion held, and what
// failed first.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "scenes/simulation.h"
#include "scenes/study/stability_case.h"

namespace app {

struct StabilityKey {
  std::string study;   // the case's name
  std::string method;  // empty: the family's own settings
  std::string level;   // of severity, as a number; empty: the stated one, over the whole duration
  bool operator==(const StabilityKey&) const = default;
};

struct StabilityFailure {
  int frame = 0;
  double time = 0;   // s
  std::string what;  // "joint_error 0.0012 m, expected <= 1e-06 m"
  std::string bodies, constraint;

  std::string where() const;  // "chain.18, chain.end, ball_socket 19"
};

struct StabilityVerdict {
  std::string text;
  bool holds = true;
  double value = 0, bound = 0;
  bool atMost = true;
  double atTime = 0;  // s
  int line = 0;       // of the file

  std::string margin() const;  // "30 % of the bound", "2 times the bound"
};

struct StabilityRun {
  enum class Status {
    kHolds,
    kFails,      // an expectation does not hold
    kNotFinite,  // a number was not finite
    kDiverged,   // a body is faster than light
    kThrew,      // the scene could not be built, or its step gave up
    kTooLong,    // given up: as much work as allowed was done
  };
  StabilityKey key;
  std::string inputs;  // hash of all that the result depends on
  Status status = Status::kHolds;
  std::optional<StabilityFailure> failure;
  std::vector<StabilityVerdict> verdicts;
  int frameCount = 0;  // of the whole case
  int frames = 0;      // simulated
  double work = 0;     // constraint evaluations, and bodies times substeps
  double seconds = 0;  // of wall time
  std::string message;

  bool holds() const { return status == Status::kHolds; }
  bool isFailure() const { return !holds() && status != Status::kTooLong; }
};
const char* statusName(StabilityRun::Status status);

struct StabilityLimits {
  bool stopAtFailure = false;  // no later frame can mend it
  double mostWork = 0;         // 0: no limit
  int mostFrames = 0;          // 0: all
};

// Shows every frame; `failed`: an expectation has failed by now.
using StabilityVisit = std::function<void(const scenes::Simulation& simulation, bool failed)>;

// None: interrupted. Never throws for what the case does. With `more` than the case's own
// overrides, an expectation whose span was cut off is not held against it.
std::optional<StabilityRun> runStability(const scenes::StabilityCase& study,
                                         const std::vector<std::string>& more,
                                         const StabilityLimits& limits,
                                         const StabilityVisit& visit);

// runs.jsonl: a line for each run, in the order they were made. Lines that are torn or not
// understood are left out.
class StabilityStore {
 public:
  StabilityStore(std::filesystem::path path, bool keep);
  // Null: not run with the same inputs.
  const StabilityRun* find(const StabilityKey& key, const std::string& inputs) const;
  double secondsOf(const StabilityKey& key) const;  // when it was run last, from any inputs; else 0
  void append(const StabilityRun& run);             // from any thread; to the file at once

 private:
  std::filesystem::path path_;
  std::vector<StabilityRun> earlier_;
  std::mutex mutex_;
};

}  // namespace app
