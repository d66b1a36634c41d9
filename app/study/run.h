// A run of a study, a scene with overrides in our engine or in another, and the trace that it
// leaves: how it ended, what it cost, how wrong it was.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/simulation.h"
#include "scenes/study/study_trace.h"

namespace app {

struct RunKey {               // names a run in its study
  std::string study, method;  // the case; the method, or what is chosen
  int steps = 1, substeps = 1;
  int iterations = 0;   // 0: the scene's own
  double accuracy = 0;  // asked for, relative; 0: none is, the steps say how fine
  std::string level{};  // of severity, as a number; empty: the stated one

  bool operator==(const RunKey&) const = default;
  double work() const;       // sweeps per sample, as far as the key says
  std::string text() const;  // "4 x 20 substeps, 8 iterations", "accuracy 1e-3"
};
std::string accuracyText(double accuracy);  // "1e-3"

struct RunLimits {
  double processor = 0;  // s; 0: none
  double work = 0;       // as Trace::work; 0: none
  int frames = 0;        // 0: the scene's
};

struct Run {
  RunKey key;
  std::string inputs;  // hash of all that the trace depends on
  std::string scene;   // what readScene takes
  std::vector<std::string> set;
  std::string engine;  // of peerMethods(); empty: ours
  int every = 1;       // World steps, or steps of the engine, between frames that are looked at
  double h = 0;        // s, of the engine
  int untimed = 0;     // steps at the start whose time does not count
  RunLimits limits;
};

struct TraceVerdict {
  std::string metric, text;
  bool holds = true, atMost = true;
  double value = 0, bound = 0;
  double atTime = 0;  // s
  int line = 0;       // of the file

  std::string margin() const;  // "30 % of the bound"; empty: the bound is none to come near to
  double share() const;        // of the bound that is used up; beyond 1: does not hold
};

struct TraceFailure {
  int frame = 0;
  double time = 0;   // s
  std::string what;  // "joint_error 0.0012 m, expected <= 1e-06 m"
  std::string bodies, constraint;

  std::string where() const;  // "chain.18, chain.end, ball_socket 19"
};

struct Trace {
  enum class Status {
    kOk,
    kFails,      // an expectation does not hold
    kNotFinite,  // a number was not finite
    kDiverged,   // a body is faster than light
    kExploded,   // the error exceeds 1000 times the case's scale
    kTooSlow,    // given up while it ran
    kRefused,    // the method cannot do this scene, or the scene cannot be made
    kSkipped,    // not run: it would have taken too long
    kMissing,    // not run, and not to be run now
  };
  RunKey key;
  std::string inputs;
  Status status = Status::kOk;
  std::string message;                 // why it is not ok
  double h = 0;                        // s; 0: the method chooses its steps
  int frameCount = 0, frames = 0;      // of the whole run; those looked at
  scenes::StudyErrors errors;          // from what it should have been
  scenes::StudyWorst worst;            // over all frames
  std::vector<TraceVerdict> verdicts;  // of the scene's expectations
  std::optional<TraceFailure> failure;
  std::vector<scenes::QuantitySamples> samples;  // of a run that others are compared with
  // Per simulated second. Wall time: the least and the median of the repeats, and how much the
  // slowest took beyond the least, relative.
  double wall = 0, wallMedian = 0, wallSpread = 0, processor = 0;
  double evaluations = 0;  // of constraints
  double sweeps = 0;
  double restarts = 0, fallbacks = 0;  // of second-order steps
  double pieces = 0;                   // steps that the method chose, taken or rejected
  double estimate = 0;                 // of the error, by the method that was asked; relative
  double work = 0;                     // in all: constraint evaluations, bodies times substeps
  double seconds = 0;                  // in all: of wall time
  int repeats = 0;
  double load = 0;  // the machine's average over the last minute

  // What is compared: the wall time, or the processor's time where other programs took the
  // processor meanwhile.
  double cost() const;
  bool isOk() const { return status == Status::kOk; }
  bool isFailure() const;  // it ran, and its result is worthless
};
const char* statusName(Trace::Status status);
std::string loadText(const std::vector<Trace>& traces);  // "load average up to 1.3"

// Is shown every frame that is looked at, and may end the run with a status of its own; false:
// enough.
using RunVisit = std::function<bool(const scenes::Simulation& simulation, Trace& trace)>;

// Steps a run once and counts what it does; times are those of this once. None: interrupted. Never
// throws for what the run does.
std::optional<Trace> perform(const Run& run, const RunVisit& visit = {});

struct RunTimes {
  double wall = 0, processor = 0;  // per simulated second
};
struct RunEffort {
  int least = 3, most = 15;  // repeats
  double longest = 0.4;      // s of the processor that more than the least may take together
};
// Steps runs again and again, in turn, only to time them: of each run the times of its repeats.
// None: interrupted.
std::optional<std::vector<std::vector<RunTimes>>> timeInTurn(std::span<const Run> runs,
                                                             const RunEffort& effort);

// The times of a trace from those of its repeats, or of its only run.
void fillTimes(std::vector<RunTimes> times, Trace& trace);

}  // namespace app
