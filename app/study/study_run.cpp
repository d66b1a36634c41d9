// Running and timing points.
#include "app/study/study_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "app/base/interrupt.h"
#include "app/base/machine.h"
#include "app/base/stopwatch.h"
#include "physics/world/state.h"

namespace app {

namespace {

using scenes::InputError;
using scenes::Simulation;
using scenes::StudyCase;
using scenes::StudyMethod;
using Status = StudyPoint::Status;

constexpr double kExploded = 1e3;  // times the case's scale
constexpr double kGiveUp = 3;      // times what a point may take
constexpr int kLeastRepeats = 3;

// Reports of ours that older or simpler steps do not have count as zero.
template <class Report>
void count(const Report& report, StudyCounts& counts) {
  counts.evaluations += static_cast<double>(report.constraintEvaluations);
  counts.sweeps += report.iterations;
  counts.estimate = std::max(counts.estimate, report.accuracy.estimate);
  if constexpr (requires { report.restarts; }) counts.restarts += report.restarts;
  if constexpr (requires { report.fallbacks; }) counts.fallbacks += report.fallbacks;
}

std::unique_ptr<Peer> start(const StudyMethod& method, const Simulation& simulation,
                            int iterations) {
  try {
    PeerStart peer = startPeer(method.peer, simulation.world(), iterations);
    if (!peer.peer) throw InputError(peer.refusal);
    return std::move(peer.peer);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
}

struct Timing {
  double wall = 0, processor = 0;
};

// The run that is measured; its samples go to `tracer`. None: interrupted.
std::optional<Timing> runMeasured(StudyRun& run, const StudyCase& study, double longest,
                                  scenes::StudyTracer& tracer, StudyPoint& point) {
  tracer.observe(run.simulation());
  for (int k = 1; k < study.sampleCount(); ++k) {
    if (interrupted()) return std::nullopt;
    if (!run.advance()) {
      point.status = Status::kNotFinite;
      point.message = run.problem();
      break;
    }
    tracer.observe(run.simulation());
    if (run.processor() > longest) {
      point.status = Status::kTooSlow;
      point.message = fmt::format("given up after {:.0f} s of {:.3g} s simulated", run.processor(),
                                  static_cast<double>(k) / study.fps);
      break;
    }
  }
  return Timing{run.wall(), run.processor()};
}

// Runs that are only timed. False: interrupted.
bool repeatRun(const scenes::Scene& scene, const StudyCase& study, const StudyMethod& method,
               const StudyKey& key, const StudyEffort& effort, std::vector<Timing>& timings) {
  const double first = timings.front().processor;
  timings.clear();  // the first run warmed up, and was disturbed by being measured
  double spent = 0;
  for (int i = 0; i < effort.mostRepeats; ++i) {
    if (i >= kLeastRepeats && spent + first > effort.repeat) return true;
    StudyRun run(scene, study, method, key);
    for (int k = 1; k < study.sampleCount(); ++k) {
      if (interrupted()) return false;
      run.advance();
    }
    timings.push_back({run.wall(), run.processor()});
    spent += run.processor();
  }
  return true;
}

void fillTimes(std::vector<Timing> timings, double simulated, StudyPoint& point) {
  std::sort(timings.begin(), timings.end(),
            [](const Timing& a, const Timing& b) { return a.wall < b.wall; });
  point.repeats = static_cast<int>(timings.size());
  const double least = timings.front().wall;
  point.wall = least / simulated;
  point.wallMedian = timings[timings.size() / 2].wall / simulated;
  point.wallSpread = least > 0 ? timings.back().wall / least - 1 : 0;
  double processor = timings.front().processor;
  for (const Timing& timing : timings) processor = std::min(processor, timing.processor);
  point.processor = processor / simulated;
}

void fillErrors(const StudyCase& study, const scenes::StudyTracer& tracer,
                const scenes::StudyTrace& truth, StudyPoint& point) {
  point.worst = tracer.worst();
  if (point.status != Status::kOk) {
    point.errors = {INFINITY, INFINITY, 0};
    return;
  }
  point.errors = scenes::compare(study, tracer.trace(), truth);
  if (point.errors.error <= kExploded * study.scale) return;
  point.status = Status::kExploded;
  point.message = fmt::format("error {:.3g} {}", point.errors.error, study.unit);
}

void fillCounts(const StudyCounts& counts, double simulated, StudyPoint& point) {
  point.evaluations = counts.evaluations / simulated;
  point.sweeps = counts.sweeps / simulated;
  point.restarts = counts.restarts / simulated;
  point.fallbacks = counts.fallbacks / simulated;
  point.estimate = counts.estimate;
}

// False: interrupted.
bool measure(const StudyCase& study, const StudyMethod& method, const scenes::StudyGrid& grid,
             const scenes::StudyTrace& truth, const StudyEffort& effort, StudyPoint& point) {
  const scenes::Scene scene =
      scenes::studyScene(study, overridesOf(grid, method, study, point.key));
  StudyRun run(scene, study, method, point.key);
  scenes::StudyTracer tracer(study, run.simulation());
  const auto first = runMeasured(run, study, kGiveUp * effort.longest, tracer, point);
  if (!first) return false;
  const double simulated = static_cast<double>(std::max(1, tracer.trace().samples - 1)) / study.fps;
  fillCounts(run.counts(), simulated, point);
  fillErrors(study, tracer, truth, point);
  std::vector<Timing> timings{*first};
  const bool isShort = point.isOk() && first->processor < effort.repeat;
  if (isShort && !repeatRun(scene, study, method, point.key, effort, timings)) return false;
  fillTimes(std::move(timings), simulated, point);
  return true;
}

}  // namespace

double stepOf(const StudyCase& study, const StudyKey& key) {
  if (key.accuracy > 0) return 0;
  return 1 / (static_cast<double>(study.fps) * key.steps * key.substeps);
}

std::vector<std::string> overridesOf(const scenes::StudyGrid& grid, const StudyMethod& method,
                                     const StudyCase& study, const StudyKey& key) {
  std::vector<std::string> set = method.set;
  set.insert(set.end(), grid.set.begin(), grid.set.end());
  if (!method.peer.empty()) return set;
  set.push_back(fmt::format("simulation.fps={}", study.fps * key.steps));
  set.push_back(fmt::format("simulation.substeps={}", key.substeps));
  if (key.iterations > 0) set.push_back(fmt::format("simulation.iterations={}", key.iterations));
  if (key.accuracy > 0) set.push_back(fmt::format("simulation.accuracy={}", key.accuracy));
  return set;
}

StudyRun::StudyRun(const scenes::Scene& scene, const StudyCase& study, const StudyMethod& method,
                   const StudyKey& key)
    : simulation_(scene), steps_(key.steps) {
  if (method.peer.empty()) return;
  peer_ = start(method, simulation_, key.iterations);
  poses_ = simulation_.world().bodies().pose;
  velocities_ = simulation_.world().bodies().velocity;
  steps_ = key.steps * key.substeps;
  h_ = stepOf(study, key);
}

bool StudyRun::advance() {
  const double processor = processorSeconds();
  const Stopwatch watch;
  const bool good = peer_ ? advancePeer() : advanceOurs();
  wall_ += watch.seconds();
  processor_ += processorSeconds() - processor;
  if (!good || !peer_) return good;
  peer_->read(poses_, velocities_);
  if (simulation_.place(poses_, velocities_)) return true;
  const physics::BodyId body = physics::firstNotFinite(poses_, velocities_);
  problem_ = fmt::format("not finite: body '{}'", simulation_.bodyName(body));
  return false;
}

bool StudyRun::advanceOurs() {
  for (int step = 0; step < steps_; ++step) {
    const physics::StepReport report = simulation_.advance();
    count(report, counts_);
    if (!report.notFinite) continue;
    problem_ = fmt::format("not finite at {:.4g} s",
                           static_cast<double>(simulation_.frame()) / simulation_.scene().fps);
    return false;
  }
  return true;
}

bool StudyRun::advancePeer() {
  try {
    for (int step = 0; step < steps_; ++step) peer_->step(h_);
    return true;
  } catch (const std::runtime_error& error) {
    problem_ = error.what();
    return false;
  }
}

std::optional<StudyPoint> measurePoint(const StudyCase& study, const StudyMethod& method,
                                       const scenes::StudyGrid& grid, const StudyKey& key,
                                       const scenes::StudyTrace& truth, const StudyEffort& effort) {
  StudyPoint point;
  point.key = key;
  point.h = stepOf(study, key);
  point.load = loadAverage();
  try {
    if (!measure(study, method, grid, truth, effort, point)) return std::nullopt;
  } catch (const std::exception& error) {  // InputError, and whatever an engine throws
    point.status = Status::kRefused;
    point.message = error.what();
    point.errors = {INFINITY, INFINITY, 0};
  }
  return point;
}

}  // namespace app
