// One run of a hard case, to its end or to where it fails, and the pictures of its failure.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "app/base/build_info.h"
#include "app/study/shots.h"
#include "app/study/stability.h"
#include "scenes/measure/metrics.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using Status = Trace::Status;

constexpr double kCloseMargin = 0.5;  // of a close-up

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

void takeFailure(const scenes::Checker::Verdict& verdict, int frame, double fps, Trace& trace) {
  if (trace.failure && trace.failure->frame <= frame) return;
  trace.failure = TraceFailure{frame, frame / fps, verdict.text, "", ""};
  if (!verdict.failure) return;
  trace.failure->what = firstText(verdict);
  trace.failure->bodies = verdict.failure->bodies;
  trace.failure->constraint = verdict.failure->constraint;
}

// The expectation that failed first; what stopped the run comes after it in time. `isCut`: one
// whose span was not seen is not held against the run.
void conclude(const scenes::Checker& checker, double fps, int lastFrame, bool isCut, Trace& trace) {
  for (const scenes::Checker::Verdict& v : checker.verdicts()) {
    if (!v.seen && (isCut || trace.status != Status::kOk)) continue;
    trace.verdicts.push_back({v.expectation.metric, v.text, v.holds, v.atMost, v.value, v.bound,
                              v.atTime, v.expectation.line});
    if (v.holds) continue;
    if (trace.status == Status::kOk) trace.status = Status::kFails;
    takeFailure(v, v.failure ? v.failure->frame : lastFrame, fps, trace);
  }
}

// What the culprits look like, without what is around them; none: nobody is named.
std::optional<render::Picture> closeUp(const scenes::Simulation& simulation,
                                       const TraceFailure& failure, scenes::ViewOptions options) {
  scenes::CameraDef culprits;
  culprits.fit.any.clear();
  std::istringstream names(failure.bodies);
  for (std::string name; std::getline(names, name, ',');) {
    name.erase(0, name.find_first_not_of(' '));
    if (name != "world") culprits.fit.any.push_back(name);
  }
  scenes::MotionBounds bounds;
  bounds.include(simulation, culprits);
  if (!(bounds.low.array() <= bounds.high.array()).all()) return std::nullopt;
  options.camera = simulation.scene().camera;
  options.camera->keys.clear();
  options.camera->follow.any.clear();
  options.camera->margin = kCloseMargin;
  return scenes::view(simulation, bounds, options, {});
}

constexpr const char* kMoments[] = {"the frame before", "the first bad frame", "the frame after"};

}  // namespace

Run runOf(const scenes::StabilityCase& study, const std::vector<std::string>& set) {
  Run run;
  run.scene = study.path;
  if (!study.variant.empty()) run.set.push_back("stability.variant=" + study.variant);
  run.set.insert(run.set.end(), set.begin(), set.end());
  return run;
}

std::optional<Trace> judge(const Run& run, bool isLenient, const StabilityVisit& visit) {
  std::optional<scenes::Checker> checker;
  double fps = 1;
  int lastFrame = 0;
  const auto look = [&](const scenes::Simulation& simulation, Trace&) {
    if (!checker) checker.emplace(simulation.scene());
    checker->observe(simulation);
    fps = simulation.scene().fps;
    lastFrame = simulation.frame();
    if (visit.show) visit.show(simulation, checker->hasFailed());
    return !(visit.stopsAtFailure && checker->hasFailed());
  };
  std::optional<Trace> trace = perform(run, look);
  if (!trace) return std::nullopt;
  if (trace->status == Status::kRefused) {
    if (!trace->failure) trace->failure = TraceFailure{trace->frames, 0, trace->message, "", ""};
    return trace;
  }
  const bool isCut = isLenient || (visit.stopsAtFailure && checker->hasFailed());
  conclude(*checker, fps, lastFrame, isCut, *trace);
  const bool isLost = trace->status == Status::kNotFinite || trace->status == Status::kDiverged;
  if (isLost) trace->message.clear();  // the failure says it all
  return trace;
}

std::vector<StabilityShot> planFailureShots(const Trace& trace) {
  std::vector<StabilityShot> shots;
  if (!trace.failure || trace.status == Status::kRefused) return shots;
  const RunKey& key = trace.key;
  const std::string hash =
      hashText(fmt::format("{}\n{}\n{}\n{}", key.study, key.method, key.level, trace.inputs));
  const std::string name = fmt::format("shots/{}_{}", key.study, hash.substr(0, 6));
  const int bad = trace.failure->frame;
  const bool exists = trace.status != Status::kNotFinite;  // else the last good one
  for (int frame = std::max(0, bad - 1); frame <= std::min(bad + 1, trace.frameCount - 1);
       ++frame) {
    if (frame >= bad && !exists) break;
    shots.push_back({fmt::format("{}_{:05}.png", name, frame),
                     fmt::format("{}, {}", kMoments[frame - bad + 1], frame), frame, false});
  }
  const bool isNamed = !trace.failure->bodies.empty() && trace.failure->bodies != "world";
  const int close = exists ? bad : bad - 1;
  if (isNamed && close >= 0) {
    shots.push_back({name + "_close.png",
                     fmt::format("{} in frame {}", trace.failure->bodies, close), close, true});
  }
  return shots;
}

bool drawFailureShots(const Run& run, const Trace& trace, const std::vector<StabilityShot>& shots,
                      const fs::path& folder) {
  const auto isThere = [&](const StabilityShot& shot) { return fs::exists(folder / shot.file); };
  if (std::all_of(shots.begin(), shots.end(), isThere)) return true;
  const int first = shots.front().frame;
  Run again = run;
  for (const StabilityShot& shot : shots) {
    again.limits.frames = std::max(again.limits.frames, shot.frame + 1);
  }
  const auto renderer = openShotRenderer();
  scenes::MotionBounds bounds;
  scenes::ViewOptions options = shotOptions();
  options.overlays.contacts = options.overlays.joints = true;
  const auto show = [&](const scenes::Simulation& simulation, Trace&) {
    const int frame = simulation.frame();
    if (frame <= first && (frame % kBoundsEvery == 0 || frame == first)) bounds.include(simulation);
    for (const StabilityShot& shot : shots) {
      if (shot.frame != frame) continue;
      const auto picture = shot.isClose ? closeUp(simulation, *trace.failure, options)
                                        : scenes::view(simulation, bounds, options, {});
      if (picture) writeShot(*renderer, *picture, folder / shot.file);
    }
    return true;
  };
  return perform(again, show).has_value();
}

}  // namespace app
