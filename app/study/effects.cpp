// dbd study effects: runs scenes with and without each of their effects.
#include "app/study/effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/run/step_clock.h"
#include "app/study/study.h"
#include "scenes/joined.h"

namespace app {

namespace {

using Kind = EffectTrial::Kind;

// Those of the README's table.
constexpr const char* kScenes[] = {"pendulum",   "chain",        "heavy_chain",   "spinning_tops",
                                   "spring_net", "flag",         "ragdoll_drive", "dominoes",
                                   "pyramid",    "wrecking_ball"};

// Where a run ended.
struct End {
  std::vector<physics::Vec3> places;  // of the bodies that move
  double energy = 0;                  // J
  std::vector<scenes::Checker::Verdict> verdicts;
};

struct EffectEffort {
  int steps = 120;
  RunEffort repeats{2, 11, 20};
};

EffectEffort stepEffort(const StudyOptions& options) {
  EffectEffort effort = options.quick ? EffectEffort{20, {2, 5, 1.5}} : EffectEffort{};
  if (options.steps > 0) effort.steps = options.steps;
  if (options.repeats > 0) effort.repeats.most = options.repeats;
  effort.repeats.least = std::min(effort.repeats.least, effort.repeats.most);
  return effort;
}

End endOf(const scenes::Simulation& simulation, const scenes::Checker& checker) {
  End end{{}, simulation.metrics().total, checker.verdicts()};
  const physics::Bodies& bodies = simulation.world().bodies();
  for (physics::BodyId b = 1; b < bodies.size(); ++b) {
    if (bodies.motion[b] != physics::Motion::kStatic) end.places.push_back(bodies.pose[b].x);
  }
  return end;
}

// The warm-up: not timed, but looked at. None: interrupted.
std::optional<Trace> look(const Run& run, End& end) {
  std::optional<scenes::Checker> checker;
  return perform(run, [&](const scenes::Simulation& simulation, Trace& trace) {
    if (!checker) checker.emplace(simulation.scene());
    checker->observe(simulation);
    trace.worst.overlap = std::max(trace.worst.overlap, simulation.world().largestOverlap());
    end = endOf(simulation, *checker);
    return true;
  });
}

void compareEnds(const End& whole, const End& own, Trace& trace) {
  const auto count = std::min(whole.places.size(), own.places.size());
  double sum = 0, largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double square = (own.places[i] - whole.places[i]).squaredNorm();
    sum += square;
    largest = std::max(largest, square);
  }
  trace.errors = {count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0, std::sqrt(largest),
                  static_cast<int>(count)};
  trace.worst.energyDrift = own.energy - whole.energy;
  for (std::size_t i = 0; i < std::min(whole.verdicts.size(), own.verdicts.size()); ++i) {
    if (!whole.verdicts[i].holds || own.verdicts[i].holds) continue;
    trace.message += (trace.message.empty() ? "" : "; ") + own.verdicts[i].text;
  }
}

void fillMedians(const std::vector<RunTimes>& times, Trace& trace) {
  fillTimes(times, trace);
  std::vector<double> seconds;
  for (const RunTimes& one : times) seconds.push_back(one.processor);
  std::sort(seconds.begin(), seconds.end());
  const std::size_t n = seconds.size();
  trace.wall = seconds.front();
  trace.wallMedian = trace.processor = medianOf(seconds);
  const double middle = seconds[(3 * (n - 1) + 2) / 4] - seconds[(n - 1) / 4];
  trace.wallSpread = trace.processor > 0 ? middle / 2 / trace.processor : 0;
}

// Runs all in turn after a warm-up that also compares their ends. False: interrupted.
bool measureAll(const std::vector<Run>& runs, const EffectEffort& effort,
                std::vector<Trace>& traces) {
  std::vector<Run> good;
  End whole;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    End end;
    const auto trace = look(runs[i], end);
    if (!trace) return false;
    traces.push_back(*trace);
    traces.back().repeats = 0;
    if (!trace->isOk()) continue;
    if (i == 0) whole = end;
    if (i > 0) compareEnds(whole, end, traces.back());
    good.push_back(runs[i]);
  }
  const auto times = timeInTurn(good, effort.repeats);
  if (!times) return false;
  std::size_t next = 0;
  for (Trace& trace : traces) {
    if (trace.isOk()) fillMedians((*times)[next++], trace);
  }
  return true;
}

Run effectRun(const std::string& word, const scenes::Scene& scene,
              const std::vector<std::string>& overrides, const EffectTrial& trial, int steps) {
  Run run;
  run.key = {scene.name, trial.name, steps, scene.settings.substepCount()};
  run.scene = word;
  run.set = overrides;
  run.set.insert(run.set.end(), trial.set.begin(), trial.set.end());
  run.h = 1.0 / (scene.fps * scene.settings.substepCount());
  run.untimed = 1;  // settles what touches, and allocates
  run.limits.frames = steps + 1;
  return run;
}

// False: interrupted.
bool measureScene(const std::string& word, const StudyOptions& options, Store& store,
                  EffectResults& results) {
  const std::vector<std::string>& overrides = options.common.overrides;
  const scenes::Scene scene = scenes::readScene(word, overrides);
  const EffectEffort effort = stepEffort(options);
  const int steps = std::max(2, std::min(effort.steps, scene.frameCount() - 1));
  const std::string inputs = hashInputs(
      {scene.text, scenes::joined(overrides, "\n"), fmt::format("{}", effort.repeats.most)});
  const std::vector<EffectTrial> trials = effectTrials(results.effects);
  std::vector<Run> runs;
  bool areThere = true;
  for (const EffectTrial& trial : trials) {
    runs.push_back(effectRun(word, scene, overrides, trial, steps));
    areThere = areThere && store.find(runs.back().key, inputs) != nullptr;
  }
  std::vector<Trace> traces;
  if (!areThere && store.runs() && !measureAll(runs, effort, traces)) return false;
  results.rows.clear();
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto made = [&] { return std::optional(traces[i]); };
    const auto trace =
        areThere ? *store.find(runs[i].key, inputs) : *store.remake(runs[i].key, inputs, made);
    if (trace.status != Trace::Status::kMissing) results.rows.push_back({trials[i], trace});
  }
  return true;
}

constexpr const char* kHow =
    "Each scene is run from its start as it is, once more without each effect that can be taken "
    "out of it, and with what the program leaves out or nothing calls for: \"nothing left out\" "
    "switches off every decision of the program that something cannot matter, \"everything on\" "
    "also gives contacts to scenes that have none and the inertia of spinning bodies to all. The "
    "runs take turns; times are those on the processor, medians, and ± half the width of the "
    "middle half of the repeats. What is off is the state after the last step: a price that buys "
    "nothing is waste, and a scene without one of its effects is another scene. Every number:";

StudyFindings findingsOf(const std::vector<EffectResults>& all, const StudyOptions& options,
                         const std::string& command) {
  StudyFindings findings;
  Report& report = findings.report;
  report.title = "What each effect costs";
  report.command = command;
  report.sections.push_back(
      {"", "", {ReportText{kHow, ReportCell::Look::kPlain, false, "points.csv"}}, true});
  if (options.table) {
    findings.text =
        "| scene | effects on | ms/step | saved against everything on |\n|---|---|---|---|\n";
  }
  std::vector<Trace> points;
  for (const EffectResults& results : all) {
    if (results.rows.empty()) continue;
    findings.text += options.table ? effectsRow(results) : effectsText(results);
    report.sections.push_back(effectsSection(results));
    for (const EffectRow& row : results.rows) points.push_back(row.trace);
  }
  report.note = loadText(points);
  report.tables.emplace_back("points.csv", pointsTable(points));
  return findings;
}

}  // namespace

const EffectRow* EffectResults::find(Kind kind) const {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const EffectRow& row) { return row.trial.kind == kind; });
  return found == rows.end() ? nullptr : &*found;
}

double EffectResults::saved(const EffectRow& row) const {
  const bool isWithout = row.trial.kind == Kind::kWithout;
  const double own = row.trace.processor, whole = rows.front().trace.processor;
  const double less = isWithout ? own : whole, more = isWithout ? whole : own;
  return more > 0 ? 1 - less / more : 0;
}

double EffectResults::noise(const EffectRow& row) const {
  return (1 - saved(row)) * std::hypot(row.trace.wallSpread, rows.front().trace.wallSpread);
}

std::vector<EffectTrial> effectTrials(const std::vector<scenes::Effect>& effects) {
  std::vector<EffectTrial> trials{{Kind::kAsItIs, "as it is", {}}};
  for (const scenes::Effect& effect : effects) {
    if (effect.on && !effect.without.empty()) {
      trials.push_back({Kind::kWithout, effect.name, effect.without});
    }
  }
  trials.push_back({Kind::kNothingLeftOut, "nothing left out", {"simulation.leave_out=false"}});
  trials.push_back({Kind::kEverythingOn, "everything on", scenes::everythingOn()});
  return trials;
}

Study effectStudy(const StudyOptions& options, const std::filesystem::path&) {
  struct State {
    std::vector<std::string> words;
    std::vector<EffectResults> results;
  };
  const auto state = std::make_shared<State>();
  Study study;
  study.name = "effects";
  state->words = options.words;
  if (state->words.empty()) state->words.assign(std::begin(kScenes), std::end(kScenes));
  for (const std::string& word : state->words) {
    const scenes::Scene scene = scenes::readScene(word, options.common.overrides);
    for (const EffectResults& other : state->results) {
      if (other.name == scene.name)
        throw scenes::InputError(word + ": another scene has this name");
    }
    state->results.push_back({scene.name, scene.title, scene.fps, scenes::effectsOf(scene), {}});
    study.listing += fmt::format("{:<24} {}\n", scene.name, scene.title);
    study.tasks.push_back({scene.name, word});
  }
  study.run = [state, options](std::size_t task, Store& store) {
    return measureScene(state->words[task], options, store, state->results[task]);
  };
  study.find = [state, options, command = options.command(study.name, options.words)] {
    return std::optional(findingsOf(state->results, options, command));
  };
  return study;
}

}  // namespace app
