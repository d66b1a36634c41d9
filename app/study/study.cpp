// From tasks to a report, in one go or job by job.
#include "app/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include "app/base/console.h"
#include "app/base/output_file.h"
#include "app/base/parallel.h"
#include "app/base/shell.h"
#include "app/base/stopwatch.h"
#include "scenes/read/value.h"

namespace app {

namespace {

namespace fs = std::filesystem;

constexpr double kReportEvery = 120;  // s, so that a long study can be looked at

std::string jobOf(const Study& study, const StudyTask& task, const StudyOptions& options,
                  const fs::path& folder) {
  const std::string command = options.command(study.name, {task.word});
  return fmt::format("{}{} -o {} --run {}\n", shellQuoted(programPath()),
                     command.substr(command.find(' ')), shellQuoted(folder.string()), shellQuoted(task.id));
}

ExitCode tellInterrupted() {
  note("dbd: interrupted; the same command makes what is missing\n");
  return ExitCode::kInterrupted;
}

ExitCode runOne(const Study& study, const StudyOptions& options, Store& store) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < study.tasks.size(); ++i) {
    known.push_back(study.tasks[i].id);
    if (known.back() != options.run) continue;
    return study.run(i, store) ? ExitCode::kDone : tellInterrupted();
  }
  throw scenes::InputError(fmt::format("--run: no such run '{}'{}", options.run,
                                       scenes::didYouMean(options.run, known)));
}

// So that no thread is left with the longest at the end; in the order of the study where one thread
// does it all.
std::vector<std::size_t> orderOf(const Study& study) {
  std::vector<std::size_t> order(study.tasks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (study.threads == 1) return order;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return study.tasks[a].seconds > study.tasks[b].seconds;
  });
  return order;
}

bool runAll(const Study& study, const StudyOptions& options, const fs::path& folder, Store& store) {
  const std::vector<std::size_t> order = orderOf(study);
  double work = 0;
  for (const StudyTask& task : study.tasks) work += task.seconds;
  Progress progress(options.common.progressMode(), study.name, "running",
                    static_cast<int>(order.size()), work);
  std::mutex mutex;
  Stopwatch watch;
  const bool all = runTasks(static_cast<int>(order.size()), study.threads, [&](int i) {
    const std::size_t chosen = order[static_cast<std::size_t>(i)];
    if (!study.run(chosen, store)) return false;
    progress.advance(1, study.tasks[chosen].seconds);
    const std::lock_guard lock(mutex);
    if (study.told && !options.common.quiet) {
      say(study.told(chosen));
      flushOutput();
    }
    if (study.threads == 1 && watch.seconds() > kReportEvery) {
      if (const auto findings = study.find()) writeReport(findings->report, folder);
      watch.lap();
    }
    return true;
  });
  if (all) progress.finish();
  return all;
}

// Takes what is there of each task; gives the commands that make the rest.
std::string collect(const Study& study, const StudyOptions& options, const fs::path& folder,
                    Store& store) {
  std::string missing;
  for (std::size_t i = 0; i < study.tasks.size(); ++i) {
    const int before = store.missing();
    study.run(i, store);
    if (store.missing() > before) missing += jobOf(study, study.tasks[i], options, folder);
  }
  return missing;
}

StoreMode modeOf(const StudyOptions& options) {
  return options.collect ? StoreMode::kCollect
         : options.fresh ? StoreMode::kFresh
                         : StoreMode::kGoOn;
}

}  // namespace

std::string StudyOptions::command(const std::string& study,
                                  const std::vector<std::string>& named) const {
  std::string text = "dbd study " + study;
  for (const std::string& word : named) text += " " + shellQuoted(word);
  if (quick) text += " --quick";
  if (!methods.empty()) text += " --methods " + shellQuoted(methods);
  if (!severity.empty()) text += " --severity " + severity;
  if (steps > 0) text += fmt::format(" --steps {}", steps);
  if (repeats > 0) text += fmt::format(" --repeats {}", repeats);
  for (const std::string& setting : common.overrides) text += " --set " + shellQuoted(setting);
  return text;
}

ExitCode runStudy(const Study& study, const StudyOptions& options, const fs::path& folder) {
  if (options.list) {
    say(study.listing);
    return ExitCode::kDone;
  }
  if (options.jobs) {
    for (const StudyTask& task : study.tasks) say(jobOf(study, task, options, folder));
    return ExitCode::kDone;
  }
  Store store(folder, modeOf(options), options.run);
  if (!options.run.empty()) return runOne(study, options, store);
  std::string missing;
  if (options.collect) {
    missing = collect(study, options, folder, store);
  } else if (!runAll(study, options, folder, store)) {
    return tellInterrupted();
  }
  const std::optional<StudyFindings> findings = study.find();
  if (!findings) return tellInterrupted();
  const fs::path page = writeReport(findings->report, folder);
  if (options.table || !options.common.quiet) say(findings->text);
  if (!options.table && !options.common.quiet) say(page.string() + "\n");
  if (!missing.empty()) note("dbd: not everything was run; these make the rest:\n" + missing);
  return findings->isGood && missing.empty() ? ExitCode::kDone : ExitCode::kCheckFailed;
}

}  // namespace app
