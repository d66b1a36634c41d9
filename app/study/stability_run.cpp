// Steps a case to its end, or to where it fails.
#include "app/study/stability_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/interrupt.h"
#include "app/base/stopwatch.h"
#include "scenes/measure/metrics.h"

namespace app {

namespace {

using Status = StabilityRun::Status;
constexpr double kLight = 299792458;  // m/s: whatever is faster has diverged

double fastest(const scenes::Simulation& simulation) {
  double most = 0;
  for (const physics::Velocity& velocity : simulation.world().bodies().velocity) {
    most = std::max(most, velocity.v.norm());
  }
  return most;
}

StabilityVerdict verdictOf(const scenes::Checker::Verdict& verdict) {
  return {verdict.text,   verdict.holds,  verdict.value,           verdict.bound,
          verdict.atMost, verdict.atTime, verdict.expectation.line};
}

// The value of the first bad frame, which is not the worst one yet.
std::string firstText(const scenes::Checker::Verdict& verdict) {
  const scenes::Expectation& e = verdict.expectation;
  const std::string unit = scenes::findMetric(e.metric)->unit;
  const auto number = [&](double value) {
    return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
  };
  return fmt::format("{}{} {}, expected {} {}", e.metric, e.body.empty() ? "" : " of " + e.body,
                     number(verdict.failure->value),
                     verdict.atMost ? "<=" : ">=", number(verdict.bound));
}

class Player {
 public:
  Player(const scenes::StabilityCase& study, const std::vector<std::string>& more,
         const StabilityLimits& limits, StabilityRun& run)
      : scene_(scenes::stabilityScene(study, more)),
        simulation_(scene_),
        checker_(scene_),
        lenient_(!more.empty()),
        limits_(limits),
        run_(run) {}

  bool play(const StabilityVisit& visit) {  // false: interrupted
    run_.frameCount = scene_.frameCount();
    const int frames =
        limits_.mostFrames > 0 ? std::min(limits_.mostFrames, run_.frameCount) : run_.frameCount;
    bool goesOn = true;
    for (int frame = 0; goesOn && frame < frames; ++frame) {
      if (interrupted()) return false;
      if (frame > 0 && !advance()) break;
      checker_.observe(simulation_);
      run_.frames = frame + 1;
      visit(simulation_, checker_.hasFailed());
      goesOn = !isHopeless();
    }
    judge();
    return true;
  }

 private:
  bool advance() {
    const physics::StepReport report = simulation_.advance();
    run_.work += static_cast<double>(report.constraintEvaluations) +
                 1.0 * report.substeps * simulation_.world().bodyCount();
    if (!report.notFinite) return true;
    const auto& bad = *report.notFinite;
    fail(Status::kNotFinite, simulation_.frame() + 1,
         fmt::format("a number is not finite in substep {}", bad.substep), bad.body,
         bad.constraint);
    return false;
  }

  bool isHopeless() {
    if (const double speed = fastest(simulation_); speed > kLight) {
      fail(Status::kDiverged, simulation_.frame(), fmt::format("a body moves at {:.3g} m/s", speed),
           -1, "");
    } else if (limits_.mostWork > 0 && run_.work > limits_.mostWork) {
      run_.status = Status::kTooLong;
      run_.message = fmt::format("given up after {} frames: {:.2g} constraint evaluations",
                                 run_.frames, run_.work);
    }
    return run_.status != Status::kHolds || (limits_.stopAtFailure && checker_.hasFailed());
  }

  void fail(Status status, int frame, const std::string& what, physics::BodyId body,
            const std::string& constraint) {
    run_.status = status;
    run_.failure = StabilityFailure{frame, 1.0 * frame / scene_.fps, what,
                                    body < 0 ? "" : simulation_.bodyName(body), constraint};
  }

  // The expectation that failed first; what stopped the run comes after it in time.
  void judge() {
    for (const scenes::Checker::Verdict& verdict : checker_.verdicts()) {
      const bool isCut = !verdict.seen && (lenient_ || run_.status != Status::kHolds ||
                                           (limits_.stopAtFailure && checker_.hasFailed()));
      if (isCut) continue;
      run_.verdicts.push_back(verdictOf(verdict));
      if (verdict.holds) continue;
      if (run_.status == Status::kHolds) run_.status = Status::kFails;
      const int frame = verdict.failure ? verdict.failure->frame : simulation_.frame();
      if (run_.failure && run_.failure->frame <= frame) continue;
      run_.failure = StabilityFailure{frame, 1.0 * frame / scene_.fps, verdict.text, "", ""};
      if (!verdict.failure) continue;
      run_.failure->what = firstText(verdict);
      run_.failure->bodies = verdict.failure->bodies;
      run_.failure->constraint = verdict.failure->constraint;
    }
  }

  scenes::Scene scene_;
  scenes::Simulation simulation_;
  scenes::Checker checker_;
  bool lenient_;
  StabilityLimits limits_;
  StabilityRun& run_;
};

}  // namespace

const char* statusName(Status status) {
  constexpr const char* kNames[] = {"holds",    "fails", "not finite",
                                    "diverged", "threw", "too long"};
  return kNames[static_cast<int>(status)];
}

std::string StabilityFailure::where() const {
  return bodies + (bodies.empty() || constraint.empty() ? "" : ", ") + constraint;
}

std::string StabilityVerdict::margin() const {
  if (bound == 0) return "";
  const double share = value / bound;
  if (!std::isfinite(share)) return "";
  return std::abs(share) < 10 ? fmt::format("{:.3g} % of the bound", 100 * share)
                              : fmt::format("{:.3g} times the bound", share);
}

std::optional<StabilityRun> runStability(const scenes::StabilityCase& study,
                                         const std::vector<std::string>& more,
                                         const StabilityLimits& limits,
                                         const StabilityVisit& visit) {
  StabilityRun run;
  const Stopwatch watch;
  try {
    if (!Player(study, more, limits, run).play(visit)) return std::nullopt;
  } catch (const std::exception& error) {
    run.status = Status::kThrew;
    run.message = error.what();
    if (!run.failure) {
      run.failure = StabilityFailure{run.frames, 0, error.what(), "", ""};
    }
  }
  run.seconds = watch.seconds();
  return run;
}

}  // namespace app
