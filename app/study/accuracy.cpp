// One point of the accuracy study, and what it is compared with.
#include "app/study/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

namespace fs = std::filesystem;
using scenes::StudyCase;
using Status = Trace::Status;

constexpr double kExploded = 1e3;  // times the case's scale
constexpr double kGiveUp = 3;      // times what a point may take

// The reference with `divide` times fewer substeps, or steps where their number cannot be divided.
RunKey referenceKey(const StudyCase& study, int divide) {
  const scenes::StudyGrid& run = study.reference.run;
  RunKey key{study.name, "reference", run.steps[0], run.substeps[0], run.iterations[0]};
  int& divided = key.substeps % divide == 0 ? key.substeps : key.steps;
  divided /= divide;
  return key;
}

// None: interrupted.
std::optional<scenes::StudyTrace> runReference(const StudyCase& study, int divide,
                                               const std::string& inputs, Store& store) {
  scenes::StudyMethod method;
  method.set = study.reference.run.set;
  const Run run = runOf(study, method, {}, referenceKey(study, divide));
  const auto trace = store.findOr(run.key, inputs, [&] {
    std::optional<scenes::StudyTracer> tracer;
    auto made = perform(run, [&](const scenes::Simulation& simulation, Trace&) {
      if (!tracer) tracer.emplace(study, simulation);
      tracer->observe(simulation);
      return true;
    });
    if (made && made->isOk()) made->samples = tracer->trace().quantities;
    return made;
  });
  if (!trace) return std::nullopt;
  if (!trace->isOk()) {
    throw scenes::InputError(fmt::format("{}: the reference run failed: {} {}", study.path,
                                         statusName(trace->status), trace->message));
  }
  return scenes::StudyTrace{trace->samples, trace->frames};
}

std::string nameOfTable(const StudyCase& study) {
  if (study.reference.table.empty()) return "closed form";
  std::string name = "table " + fs::path(study.reference.table).filename().string();
  for (const auto& [column, value] : study.reference.where) {
    name += fmt::format(", {} = {:g}", column, value);
  }
  return name;
}

double stepOf(const StudyCase& study, const RunKey& key) {
  return 1 / (static_cast<double>(study.fps) * key.steps * key.substeps);
}

void fillErrors(const StudyCase& study, const scenes::StudyTracer& tracer,
                const scenes::StudyTrace& truth, Trace& trace) {
  trace.worst = tracer.worst();
  trace.errors = {INFINITY, INFINITY, 0};
  if (!trace.isOk()) return;
  trace.errors = scenes::compare(study, tracer.trace(), truth);
  if (trace.errors.error <= kExploded * study.scale) return;
  trace.status = Status::kExploded;
  trace.message = fmt::format("error {:.3g} {}", trace.errors.error, study.unit);
}

}  // namespace

std::string inputsOf(const StudyCase& study) {
  std::vector<std::string> parts{study.text, scenes::studyScene(study, {}).text,
                                 study.reference.text};
  parts.insert(parts.end(), study.set.begin(), study.set.end());
  return hashInputs(parts);
}

std::optional<StudyTruth> findTruth(const StudyCase& study, const std::string& inputs,
                                    Store& store) {
  StudyTruth truth;
  if (!study.reference.self) {
    truth.trace = scenes::truthOf(study, nullptr);
    truth.report = {nameOfTable(study), scenes::tableAccuracy(study)};
    return truth;
  }
  const auto fine = runReference(study, 1, inputs, store);
  const auto coarse = fine ? runReference(study, 2, inputs, store) : std::nullopt;
  if (!coarse) return std::nullopt;
  truth.trace = scenes::truthOf(study, &*fine);
  truth.report.accuracy = scenes::compare(study, *coarse, truth.trace).error;
  truth.report.what =
      fmt::format("a run of its own at h = {:.3g} s", stepOf(study, referenceKey(study, 1)));
  for (const std::string& setting : study.reference.run.set) truth.report.what += ", " + setting;
  return truth;
}

Run runOf(const StudyCase& study, const scenes::StudyMethod& method, const scenes::StudyGrid& grid,
          const RunKey& key) {
  Run run;
  run.key = key;
  run.scene = study.scenePath;
  run.set = study.set;
  run.set.insert(run.set.end(), method.set.begin(), method.set.end());
  run.set.insert(run.set.end(), grid.set.begin(), grid.set.end());
  run.engine = method.peer;
  run.h = stepOf(study, key);
  run.every = key.steps;
  run.limits.frames = (study.sampleCount() - 1) * key.steps + 1;
  if (!method.peer.empty()) {
    run.every = key.steps * key.substeps;
    run.limits.frames = study.sampleCount();
    return run;
  }
  const int fps = study.fps * key.steps;
  if (key.accuracy > 0) {  // and nothing else: what a user says
    run.set.push_back(fmt::format("simulation={{ fps = {}, accuracy = {} }}", fps, key.accuracy));
    return run;
  }
  run.set.push_back(fmt::format("simulation.fps={}", fps));
  run.set.push_back(fmt::format("simulation.substeps={}", key.substeps));
  if (key.iterations > 0) {
    run.set.push_back(fmt::format("simulation.iterations={}", key.iterations));
  }
  return run;
}

PointEffort effortOf(bool quick) { return quick ? PointEffort{{3, 7, 0.06}, 0.8} : PointEffort{}; }

std::optional<Trace> measurePoint(const StudyCase& study, const Run& run,
                                  const scenes::StudyTrace& truth, const PointEffort& effort) {
  Run limited = run;
  limited.limits.processor = kGiveUp * effort.longest;
  std::optional<scenes::StudyTracer> tracer;
  std::optional<Trace> trace = perform(limited, [&](const scenes::Simulation& simulation, Trace&) {
    if (!tracer) tracer.emplace(study, simulation);
    tracer->observe(simulation);
    return true;
  });
  if (!trace) return std::nullopt;
  if (!tracer) {
    trace->errors = {INFINITY, INFINITY, 0};
    return trace;
  }
  fillErrors(study, *tracer, truth, *trace);
  const bool isShort = trace->isOk() && trace->processor * study.duration < effort.repeats.longest;
  if (!isShort) return trace;
  auto times = timeInTurn({&run, 1}, effort.repeats);  // the first run warmed up, and was disturbed
  if (!times) return std::nullopt;
  fillTimes(std::move(times->front()), *trace);
  return trace;
}

}  // namespace app
