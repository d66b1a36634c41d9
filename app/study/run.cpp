// Runs, by the loop of all commands.
#include "app/study/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "app/base/machine.h"
#include "app/base/stopwatch.h"
#include "app/peers/peer.h"
#include "app/run/play.h"
#include "physics/world/state.h"

namespace app {

namespace {

using Status = Trace::Status;

// Another engine on the bodies of a simulation.
class Stand {
 public:
  Stand(const Run& run, scenes::Simulation& simulation)
      : simulation_(simulation),
        poses_(simulation.world().bodies().pose),
        velocities_(simulation.world().bodies().velocity) {
    PeerStart start = startPeer(run.engine, simulation.world(), run.key.iterations);
    if (!start.peer) throw scenes::InputError(start.refusal);
    peer_ = std::move(start.peer);
    engine_.step = [this, &run] {
      for (int k = 0; k < run.every; ++k) peer_->step(run.h);
    };
    engine_.show = [this] { return show(); };
  }
  Stand(const Stand&) = delete;
  Stand& operator=(const Stand&) = delete;
  const PlayEngine* engine() const { return &engine_; }

 private:
  std::optional<physics::StepReport::NotFinite> show() {
    peer_->read(poses_, velocities_);
    if (simulation_.place(poses_, velocities_)) return std::nullopt;
    return physics::StepReport::NotFinite{0, physics::firstNotFinite(poses_, velocities_), ""};
  }

  scenes::Simulation& simulation_;
  std::unique_ptr<Peer> peer_;
  std::vector<physics::Pose> poses_;
  std::vector<physics::Velocity> velocities_;
  PlayEngine engine_;
};

constexpr double kLight = 299792458;  // m/s: whatever is faster has diverged

double fastest(const scenes::Simulation& simulation) {
  double most = 0;
  for (const physics::Velocity& velocity : simulation.world().bodies().velocity) {
    most = std::max(most, velocity.v.norm());
  }
  return most;
}

void count(const physics::StepReport& report, int bodies, Trace& trace) {
  trace.evaluations += static_cast<double>(report.constraintEvaluations);
  trace.sweeps += report.iterations;
  trace.restarts += report.restarts;
  trace.fallbacks += report.fallbacks;
  trace.pieces += report.accuracy.accepted + report.accuracy.rejected;
  trace.estimate = std::max(trace.estimate, report.accuracy.estimate);
  trace.work += static_cast<double>(report.constraintEvaluations) + 1.0 * report.substeps * bodies;
}

void failNotFinite(const scenes::Simulation& simulation,
                   const physics::StepReport::NotFinite& where, Trace& trace) {
  const int frame = simulation.frame() + 1;
  const double fps = simulation.scene().fps;
  trace.status = Status::kNotFinite;
  trace.failure = TraceFailure{
      frame, frame / fps, fmt::format("a number is not finite in substep {}", where.substep),
      where.body < 0 ? "" : simulation.bodyName(where.body), where.constraint};
  const std::string at = trace.failure->where();
  trace.message =
      fmt::format("not finite at {:.4g} s{}{}", frame / fps, at.empty() ? "" : ": ", at);
}

// One run: the loop's visitor, and what it counts.
class Performance {
 public:
  Performance(const Run& run, const RunVisit& visit, Trace& trace)
      : run_(run),
        visit_(visit),
        trace_(trace),
        simulation_(scenes::readScene(run.scene, run.set)) {
    if (!run.engine.empty()) stand_.emplace(run, simulation_);
    stride_ = stand_ ? 1 : run.every;
    trace_.frameCount = simulation_.scene().frameCount();
  }

  bool play() {  // false: interrupted
    const int frames = run_.limits.frames > 0 ? run_.limits.frames : trace_.frameCount;
    PlayEnd end;
    try {
      end = app::play(
          simulation_, frames, [&](const PlayedStep& step) { return follow(step); },
          stand_ ? stand_->engine() : nullptr);
      if (end.notFinite) failNotFinite(simulation_, *end.notFinite, trace_);
    } catch (const EnvironmentError&) {
      throw;
    } catch (const std::runtime_error& error) {  // another engine gives up
      if (!stand_) throw;
      trace_.status = Status::kNotFinite;
      trace_.message = error.what();
    }
    finish();
    return end.code != ExitCode::kInterrupted;
  }

 private:
  bool follow(const PlayedStep& step) {
    count(step.report, simulation_.world().bodyCount(), trace_);
    if (steps_ > run_.untimed) {
      times_.wall += step.wall;
      times_.processor += step.processor;
    }
    spent_ += step.processor;
    if (steps_++ % stride_ != 0) return true;
    ++trace_.frames;
    const bool isLost = hasDiverged();
    if (visit_ && !visit_(simulation_, trace_)) return false;
    return !isLost && !isTooMuch();
  }

  bool hasDiverged() {
    const double speed = fastest(simulation_);
    if (speed <= kLight) return false;
    const int frame = simulation_.frame();
    trace_.status = Status::kDiverged;
    trace_.message = fmt::format("a body moves at {:.3g} m/s", speed);
    const double time = frame / static_cast<double>(simulation_.scene().fps);
    trace_.failure = TraceFailure{frame, time, trace_.message, "", ""};
    return true;
  }

  bool isTooMuch() {
    const RunLimits& limits = run_.limits;
    const double time = simulatedSeconds(steps_ - 1);
    if (limits.processor > 0 && spent_ > limits.processor) {
      trace_.message = fmt::format("given up after {:.0f} s of {:.3g} s simulated", spent_, time);
    } else if (limits.work > 0 && trace_.work > limits.work) {
      trace_.message = fmt::format("given up after {} frames: {:.2g} constraint evaluations",
                                   trace_.frames, trace_.work);
    } else {
      return false;
    }
    trace_.status = Status::kTooSlow;
    return true;
  }

  double simulatedSeconds(int steps) const { return 1.0 * steps / simulation_.scene().fps; }

  void finish() {
    const double simulated = simulatedSeconds(std::max(1, steps_ - 1));
    for (double* sum : {&trace_.evaluations, &trace_.sweeps, &trace_.restarts, &trace_.fallbacks,
                        &trace_.pieces}) {
      *sum /= simulated;
    }
    const double timed = simulatedSeconds(std::max(1, steps_ - 1 - run_.untimed));
    fillTimes({{times_.wall / timed, times_.processor / timed}}, trace_);
  }

  const Run& run_;
  const RunVisit& visit_;
  Trace& trace_;
  scenes::Simulation simulation_;
  std::optional<Stand> stand_;
  int stride_ = 1, steps_ = 0;
  double spent_ = 0;  // s of the processor
  RunTimes times_;
};

constexpr const char* kStatusNames[] = {"ok",       "fails",   "not finite", "diverged", "exploded",
                                        "too slow", "refused", "skipped",    "missing"};

}  // namespace

double RunKey::work() const {
  return static_cast<double>(steps) * substeps * std::max(1, iterations);
}

std::string accuracyText(double accuracy) {
  const int exponent = static_cast<int>(std::floor(std::log10(accuracy) + 1e-9));
  return fmt::format("{:.3g}e{}", accuracy * std::pow(10.0, -exponent), exponent);
}

std::string RunKey::text() const {
  if (accuracy > 0) return "accuracy " + accuracyText(accuracy);
  std::string text = steps > 1 ? fmt::format("{} x ", steps) : "";
  text += fmt::format("{} substep{}", substeps, substeps == 1 ? "" : "s");
  if (iterations > 0)
    text += fmt::format(", {} iteration{}", iterations, iterations == 1 ? "" : "s");
  return text;
}

double TraceVerdict::share() const {
  if (!holds) return 1e300;
  if (bound == 0 || value == 0 || metric == "finite") return 0;
  return atMost == (bound > 0) ? value / bound : bound / value;
}

std::string TraceVerdict::margin() const {
  const double used = value / bound;
  if (bound == 0 || metric == "finite" || !std::isfinite(used)) return "";
  return std::abs(used) < 10 ? fmt::format("{:.3g} % of the bound", 100 * used)
                             : fmt::format("{:.3g} times the bound", used);
}

std::string TraceFailure::where() const {
  return bodies + (bodies.empty() || constraint.empty() ? "" : ", ") + constraint;
}

double Trace::cost() const { return processor > 0 ? std::min(wall, processor) : wall; }

bool Trace::isFailure() const {
  return status != Status::kOk && status != Status::kRefused && status != Status::kSkipped &&
         status != Status::kMissing;
}

const char* statusName(Status status) { return kStatusNames[static_cast<int>(status)]; }

std::string loadText(const std::vector<Trace>& traces) {
  double load = 0;
  for (const Trace& trace : traces) load = std::max(load, trace.load);
  return fmt::format("load average up to {:.1f}", load);
}

std::optional<Trace> perform(const Run& run, const RunVisit& visit) {
  Trace trace;
  trace.key = run.key;
  trace.inputs = run.inputs;
  trace.h = run.key.accuracy > 0 ? 0 : run.h;
  trace.load = loadAverage();
  const Stopwatch watch;
  try {
    if (!Performance(run, visit, trace).play()) return std::nullopt;
  } catch (const EnvironmentError&) {  // of a visit: a picture that cannot be written
    throw;
  } catch (const std::exception& error) {  // InputError, and whatever an engine throws
    trace.status = Status::kRefused;
    trace.message = error.what();
  }
  trace.seconds = watch.seconds();
  return trace;
}

std::optional<std::vector<std::vector<RunTimes>>> timeInTurn(std::span<const Run> runs,
                                                             const RunEffort& effort) {
  std::vector<std::vector<RunTimes>> times(runs.size());
  const double begin = processorSeconds();
  double round = 0;
  for (int k = 0; k < effort.most; ++k) {
    const double spent = processorSeconds() - begin;
    if (k >= effort.least && spent + round > effort.longest) break;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::optional<Trace> trace = perform(runs[i]);
      if (!trace) return std::nullopt;
      times[i].push_back({trace->wall, trace->processor});
    }
    round = processorSeconds() - begin - spent;
  }
  return times;
}

void fillTimes(std::vector<RunTimes> times, Trace& trace) {
  if (times.empty()) return;
  std::sort(times.begin(), times.end(),
            [](const RunTimes& a, const RunTimes& b) { return a.wall < b.wall; });
  const double least = times.front().wall;
  trace.repeats = static_cast<int>(times.size());
  trace.wall = least;
  trace.wallMedian = times[times.size() / 2].wall;
  trace.wallSpread = least > 0 ? times.back().wall / least - 1 : 0;
  trace.processor = times.front().processor;
  for (const RunTimes& one : times) trace.processor = std::min(trace.processor, one.processor);
}

}  // namespace app
