// dbd study stability: runs what is missing of the cases and of the searches for their borders.
#include "app/study/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "app/base/output_file.h"
#include "app/study/shots.h"
#include "scenes/read/settings_reader.h"
#include "scenes/study/study_files.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using scenes::StabilityCase;

constexpr double kMostStatedRuns = 10;      // a level may cost as much work as so many stated runs
constexpr double kLeastWorkPerFrame = 1e4;  // and this in any case
constexpr double kMostWorkOfSearch = 1e8;   // no further level is tried after so much

// "simulation.method=direct" says what the family says, or what is the default.
bool isOwn(const scenes::Value& settings, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const scenes::Value* own = scenes::findValue(settings, setting.substr(0, equals));
  const std::string value = setting.substr(equals + 1);
  if (own != nullptr) return own->text == value;
  const physics::Settings otherwise;
  return setting == fmt::format("simulation.method={}", scenes::wordOf(otherwise.method)) ||
         setting == fmt::format("simulation.stepping={}", scenes::wordOf(otherwise.stepping));
}

bool isOwn(const scenes::StabilityFamily& family, const std::vector<std::string>& set) {
  return std::all_of(set.begin(), set.end(),
                     [&](const std::string& s) { return isOwn(family.settings, s); });
}

// Of the case's duration, what a run that searches lasts.
double searchedShare(const StabilityCase& study) {
  return study.severity->duration.value_or(study.duration) / study.duration;
}

struct StabilityTask {
  std::size_t result = 0;
  int bar = -1;  // none: the stated level
};

struct StabilityState {
  std::vector<StabilityResult> results;
  std::vector<StabilityTask> tasks;
  std::vector<std::unique_ptr<std::mutex>> mutexes;  // of the stated runs
  fs::path folder;
  std::string families;
  int reused = 0;
};

std::string stabilityInputs(const StabilityState& state, const StabilityResult& result,
                            const std::vector<std::string>& set) {
  std::vector<std::string> parts{state.families, result.study.text, result.study.variant};
  parts.insert(parts.end(), set.begin(), set.end());
  return hashInputs(parts);
}

std::optional<Trace> runOrFind(const StabilityState& state, const StabilityResult& result, Run& run,
                               const std::vector<std::string>& set, bool stopsAtFailure,
                               const std::function<void(const scenes::Simulation&, bool)>& show,
                               Store& store) {
  run.inputs = stabilityInputs(state, result, set);
  return store.findOr(run.key, run.inputs, [&] {
    return judge(run, !set.empty(), {show, stopsAtFailure});
  });
}

// The last frame, framed by all that came before its failure.
struct EndPicture {
  scenes::MotionBounds bounds;
  std::optional<render::Picture> picture;

  void observe(const scenes::Simulation& simulation, bool failed) {
    const bool isLast = simulation.frame() + 1 == simulation.scene().frameCount();
    const bool counts = simulation.frame() % kBoundsEvery == 0 || isLast;
    if ((counts && !failed) || simulation.frame() == 0) bounds.include(simulation);
    if (isLast) picture = scenes::view(simulation, bounds, shotOptions(), {});
  }
};

// False: interrupted.
bool judgeStated(StabilityState& state, std::size_t index, Store& store) {
  StabilityResult& result = state.results[index];
  const std::lock_guard lock(*state.mutexes[index]);
  if (result.stated) return true;
  Run run = runOf(result.study, {});
  run.key.study = result.study.name;
  EndPicture end;
  const auto trace = runOrFind(
      state, result, run, {}, false,
      [&](const scenes::Simulation& simulation, bool failed) { end.observe(simulation, failed); },
      store);
  if (!trace || trace->status == Trace::Status::kMissing) return trace.has_value();
  const std::string file =
      fmt::format("ends/{}_{}.png", result.study.name, trace->inputs.substr(0, 6));
  if (end.picture) writeShot(*openShotRenderer(), *end.picture, state.folder / file);
  result.shots = {{file, fmt::format("after {} frames", trace->frames), 0, false}};
  if (trace->isFailure()) result.failureShots = planFailureShots(*trace);
  result.stated = *trace;
  if (!store.runs() || result.failureShots.empty()) return true;
  return drawFailureShots(run, *trace, result.failureShots, state.folder);
}

// False: interrupted.
bool searchBar(StabilityState& state, const StabilityResult& result, StabilityBar& bar,
               Store& store) {
  const scenes::StabilitySeverity& severity = *result.study.severity;
  const Trace& stated = *result.stated;
  const double leastWork = kLeastWorkPerFrame * std::max(1, stated.frames);
  std::vector<Trace> traces;
  double work = 0;
  bool isMissing = false;
  bar.border = searchSeverity(severity, [&](double level) -> std::optional<bool> {
    if (work > kMostWorkOfSearch) return std::nullopt;
    const std::vector<std::string> set = overridesOf(bar.way, severity, level);
    Run run = runOf(result.study, set);
    run.key = {result.study.name, bar.way.method};
    run.key.level = fmt::format("{}", level);
    run.limits.work =
        kMostStatedRuns * searchedShare(result.study) * std::max(stated.work, leastWork);
    const auto trace = runOrFind(state, result, run, set, true, {}, store);
    isMissing = trace && trace->status == Trace::Status::kMissing;
    if (!trace || isMissing) return std::nullopt;
    work += trace->work;
    traces.push_back(*trace);
    return trace->isOk();
  });
  const bool isInterrupted = bar.border.stopped && !isMissing && work <= kMostWorkOfSearch;
  bar.isSpent = bar.border.stopped && !isInterrupted && bar.border.holds != severity.to;
  if (!bar.border.fails || isInterrupted) return !isInterrupted;
  const std::string level = fmt::format("{}", *bar.border.fails);
  bar.firstFailure = *std::find_if(traces.begin(), traces.end(),
                                   [&](const Trace& t) { return t.key.level == level; });
  bar.shots = planFailureShots(*bar.firstFailure);
  if (!store.runs() || bar.shots.empty()) return true;
  return drawFailureShots(runOf(result.study, overridesOf(bar.way, severity, *bar.border.fails)),
                          *bar.firstFailure, bar.shots, state.folder);
}

bool runTask(StabilityState& state, const StabilityTask& task, Store& store) {
  StabilityResult& result = state.results[task.result];
  if (!result.problem.empty()) return true;
  if (!judgeStated(state, task.result, store)) return false;
  if (task.bar < 0 || !result.stated) return true;
  return searchBar(state, result, result.bars[static_cast<std::size_t>(task.bar)], store);
}

// A file that cannot be read fails as a case of that name does.
StabilityResult unread(const std::string& word, const std::string& problem) {
  StabilityResult result;
  result.study.name = fs::path(word).stem().string();
  result.study.title = result.study.name;
  result.problem = problem;
  return result;
}

// Words of the command line must name cases; of the whole catalogue one bad file is one failure.
std::vector<StabilityResult> readAll(const StudyOptions& options) {
  const bool all = options.words.empty();
  std::vector<StabilityResult> results;
  for (const std::string& word : all ? scenes::stabilityFiles() : options.words) {
    try {
      for (StabilityCase& study : scenes::readStabilityCases(word)) {
        if (options.quick && all && !study.quick) continue;
        study.text = scenes::stabilityScene(study, {}).text;  // with what it includes
        results.push_back({std::move(study), "", {}, {}, {}, {}});
      }
    } catch (const scenes::InputError& error) {
      if (!all) throw;
      results.push_back(unread(word, error.what()));
    }
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (results[i].study.name != results[k].study.name) continue;
      throw scenes::InputError(fmt::format("two cases have the name {}", results[i].study.name));
    }
  }
  if (results.empty()) throw scenes::InputError("study: there is no case to run");
  return results;
}

std::string listing(const std::vector<StabilityResult>& results) {
  std::string text;
  for (const StabilityResult& result : results) {
    const auto& severity = result.study.severity;
    text += fmt::format("{:<24} {:<12} {}{}{}\n", result.study.name, result.study.family.name,
                        result.problem.empty() ? result.study.title : result.problem,
                        result.study.quick ? " (quick)" : "",
                        severity ? fmt::format("\n{:<24} {:<12}   {}: {:g}, up to {:g}", "", "",
                                               severity->label, severity->stated, severity->to)
                                 : "");
  }
  return text;
}

// A stated run for each case, and a search for each way where one is asked for. Those that took
// longest come first.
void planTasks(bool searches, StabilityState& state, Study& study) {
  const Store known(state.folder, StoreMode::kLook, "");
  for (std::size_t i = 0; i < state.results.size(); ++i) {
    StabilityResult& result = state.results[i];
    const StabilityCase& own = result.study;
    const std::string word = own.variant.empty() ? own.path : own.path + "." + own.variant;
    RunKey key;
    key.study = own.name;
    const double seconds = known.secondsOf(key);
    state.mutexes.push_back(std::make_unique<std::mutex>());
    state.tasks.push_back({i, -1});
    study.tasks.push_back({own.name, word, seconds});
    if (!searches || !result.problem.empty() || !own.severity) continue;
    for (const StabilityWay& way : waysOf(own)) {
      state.tasks.push_back({i, static_cast<int>(result.bars.size())});
      study.tasks.push_back(
          {fmt::format("{}.search{}{}", own.name, way.method.empty() ? "" : ".", way.method), word,
           seconds * searchedShare(own)});
      result.bars.push_back({way, {}, false, std::nullopt, {}});
    }
  }
}

}  // namespace

std::vector<StabilityWay> waysOf(const StabilityCase& study) {
  std::vector<StabilityWay> ways{{"", study.family.name + "'s settings", "#000000", {}}};
  for (const scenes::StudyMethod& method : scenes::studyMethods()) {
    if (!method.peer.empty() || !isOwn(study.family, method.set)) continue;
    ways[0].title = method.title;
    ways[0].color = method.color;
  }
  for (const scenes::StudyMethod& method : study.methods) {
    if (isOwn(study.family, method.set)) continue;
    ways.push_back({method.name, method.title, method.color, method.set});
  }
  return ways;
}

std::vector<std::string> overridesOf(const StabilityWay& way,
                                     const scenes::StabilitySeverity& severity, double level) {
  std::vector<std::string> set = way.set;
  if (severity.duration) set.push_back(fmt::format("duration={}", *severity.duration));
  for (const std::string& setting : severity.overrides(level)) set.push_back(setting);
  return set;
}

Study stabilityStudy(const StudyOptions& options, const fs::path& folder) {
  const auto state = std::make_shared<StabilityState>();
  state->results = readAll(options);
  state->folder = folder;
  state->families =
      scenes::readStudyText((fs::path(scenes::studyFolder()) / "stability_families.toml").string());
  Study study;
  study.name = "stability";
  study.listing = listing(state->results);
  study.threads = options.common.threadCount();
  planTasks(!options.severity.empty(), *state, study);
  study.run = [state](std::size_t task, Store& store) {
    const bool done = runTask(*state, state->tasks[task], store);
    state->reused = store.reused();
    return done;
  };
  study.told = [state](std::size_t task) {
    const StabilityTask& done = state->tasks[task];
    return done.bar < 0 ? verdictText(state->results[done.result]) : "";
  };
  study.find = [state, searches = !options.severity.empty(),
                command = options.command(study.name, options.words)] {
    return std::optional(stabilityFindings(state->results, searches, command, state->reused));
  };
  return study;
}

}  // namespace app
