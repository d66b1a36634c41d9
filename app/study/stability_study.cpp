// Runs what is missing, on as many threads as asked; each run is single-threaded.
#include "app/study/stability_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/base/build_info.h"
#include "app/base/output_file.h"
#include "app/base/parallel.h"
#include "app/study/study_effort.h"
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

const fs::path& madeFolder(const fs::path& folder) {
  makeFolder(folder);
  return folder;
}

// Of the case's duration, what a run that searches lasts.
double searchedShare(const StabilityCase& study) {
  return study.severity->duration.value_or(study.duration) / study.duration;
}

std::string endFile(const StabilityRun& run) {
  return fmt::format("ends/{}_{}.png", run.key.study, run.inputs.substr(0, 6));
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

std::string reproduction(const StabilityCase& study, const std::vector<std::string>& set,
                         const StabilityRun& run) {
  std::error_code error;
  const fs::path near = fs::proximate(study.path, error);
  const bool isBelow = !error && !near.empty() && *near.begin() != "..";
  std::string text = "dbd render " + (isBelow ? near.string() : study.path);
  if (!study.variant.empty()) text += " --set stability.variant=" + study.variant;
  for (const std::string& setting : set) text += " --set '" + setting + "'";
  if (run.failure) {
    const int frame = run.failure->frame;
    text += fmt::format(" --frames {}:{} --overlays contacts,joints", std::max(0, frame - 1),
                        frame + 2);
  }
  return text;
}

StabilityStudy::StabilityStudy(std::vector<StabilityResult> cases, fs::path folder, bool keep,
                               int threads, ProgressMode progress)
    : results_(std::move(cases)),
      folder_(madeFolder(folder)),
      store_(folder_ / "runs.jsonl", keep),
      threads_(threads),
      progress_(progress) {}

std::string StabilityStudy::inputsOf(const StabilityResult& result,
                                     const std::vector<std::string>& set) const {
  static const std::string program = programHash();
  static const std::string families =
      scenes::readStudyText((fs::path(scenes::studyFolder()) / "stability_families.toml").string());
  return hashText(program + result.study.text + families + joinedLines(set));
}

double StabilityStudy::secondsBefore(const StabilityKey& key) const {
  constexpr double kGuess = 2;  // s
  const double seconds = store_.secondsOf(key);
  return seconds > 0 ? seconds : kGuess;
}

std::optional<StabilityRun> StabilityStudy::runOf(const StabilityResult& result,
                                                  const StabilityKey& key,
                                                  const std::vector<std::string>& set,
                                                  const StabilityLimits& limits,
                                                  const StabilityVisit& visit) {
  const std::string inputs = inputsOf(result, set);
  if (const StabilityRun* run = store_.find(key, inputs)) {
    const std::lock_guard lock(mutex_);
    ++reused_;
    return *run;
  }
  std::optional<StabilityRun> run = runStability(result.study, set, limits, visit);
  if (!run) return std::nullopt;
  run->key = key;
  run->inputs = inputs;
  store_.append(*run);
  return run;
}

bool StabilityStudy::judgeCase(StabilityResult& result) {
  if (!result.problem.empty()) return true;
  EndPicture end;
  const auto visit = [&](const scenes::Simulation& simulation, bool failed) {
    end.observe(simulation, failed);
  };
  const auto run = runOf(result, {result.study.name, "", ""}, {}, {}, visit);
  if (!run) return false;
  result.stated = *run;
  const std::string file = endFile(*run);
  end.write(folder_ / file);
  if (fs::exists(folder_ / file)) {
    result.shots.push_back({file, fmt::format("after {} frames", run->frames), 0, false});
  }
  return true;
}

// So that no thread is left with the longest at the end.
bool StabilityStudy::runLongestFirst(const std::string& stage, const std::vector<double>& work,
                                     const std::function<bool(std::size_t)>& task) {
  std::vector<std::size_t> order(work.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
  const int count = static_cast<int>(work.size());
  Progress progress(progress_, "stability", stage, count,
                    std::accumulate(work.begin(), work.end(), 0.0));
  const bool all = runTasks(count, threads_, [&](int i) {
    const std::size_t chosen = order[static_cast<std::size_t>(i)];
    if (!task(chosen)) return false;
    progress.advance(1, work[chosen]);
    return true;
  });
  if (all) progress.finish();
  return all;
}

bool StabilityStudy::judge(const std::function<void(const StabilityResult&)>& done) {
  std::vector<StabilityResult*> tasks;
  std::vector<double> work;
  for (StabilityResult& result : results_) {
    const StabilityKey key{result.study.name, "", ""};
    const bool isKnown = store_.find(key, inputsOf(result, {})) != nullptr;
    tasks.push_back(&result);
    work.push_back(isKnown ? 0 : secondsBefore(key));
  }
  return runLongestFirst("running", work, [&](std::size_t i) {
    if (!judgeCase(*tasks[i])) return false;
    const std::lock_guard lock(mutex_);
    done(*tasks[i]);
    return true;
  });
}

bool StabilityStudy::searchBar(const StabilityResult& result, StabilityBar& bar) {
  const scenes::StabilitySeverity& severity = *result.study.severity;
  const StabilityRun& stated = result.stated;
  const double leastWork = kLeastWorkPerFrame * std::max(1, stated.frames);
  const StabilityLimits limits{
      true, kMostStatedRuns * searchedShare(result.study) * std::max(stated.work, leastWork)};
  std::vector<StabilityRun> runs;
  double work = 0;
  const auto judge = [&](double level) -> std::optional<bool> {
    if (work > kMostWorkOfSearch) return std::nullopt;
    const std::vector<std::string> set = overridesOf(bar.way, severity, level);
    const StabilityKey key{result.study.name, bar.way.method, fmt::format("{}", level)};
    auto run = runOf(result, key, set, limits, [](const scenes::Simulation&, bool) {});
    if (!run) return std::nullopt;
    work += run->work;
    runs.push_back(std::move(*run));
    return runs.back().holds();
  };
  bar.border = searchSeverity(severity, judge);
  if (bar.border.fails) {
    const std::string level = fmt::format("{}", *bar.border.fails);
    const auto found = std::find_if(
        runs.begin(), runs.end(), [&](const StabilityRun& run) { return run.key.level == level; });
    bar.firstFailure = *found;
    bar.shots = planFailureShots(*found);
  }
  const bool isInterrupted = bar.border.stopped && work <= kMostWorkOfSearch;
  bar.isSpent = bar.border.stopped && !isInterrupted && bar.border.holds != severity.to;
  return !isInterrupted;
}

bool StabilityStudy::search() {
  struct Task {
    StabilityResult* result;
    std::size_t bar;
  };
  std::vector<Task> tasks;
  std::vector<double> work;
  for (StabilityResult& result : results_) {
    if (!result.problem.empty() || !result.study.severity) continue;
    result.bars.clear();
    const double seconds = result.stated.seconds * searchedShare(result.study);
    for (const StabilityWay& way : waysOf(result.study)) {
      tasks.push_back({&result, result.bars.size()});
      work.push_back(seconds);
      result.bars.push_back({way, {}, false, std::nullopt, {}});
    }
  }
  return runLongestFirst("searching borders", work, [&](std::size_t i) {
    return searchBar(*tasks[i].result, tasks[i].result->bars[tasks[i].bar]);
  });
}

bool StabilityStudy::draw() {
  return runTasks(static_cast<int>(results_.size()), threads_, [&](int i) {
    StabilityResult& result = results_[static_cast<std::size_t>(i)];
    if (!result.problem.empty()) return true;
    if (result.stated.isFailure()) {
      result.failureShots = planFailureShots(result.stated);
      if (!drawFailureShots(result.study, {}, result.stated, result.failureShots, folder_)) {
        return false;
      }
    }
    for (const StabilityBar& bar : result.bars) {
      if (!bar.firstFailure || bar.shots.empty()) continue;
      const auto set = overridesOf(bar.way, *result.study.severity, *bar.border.fails);
      if (!drawFailureShots(result.study, set, *bar.firstFailure, bar.shots, folder_)) return false;
    }
    return true;
  });
}

}  // namespace app
