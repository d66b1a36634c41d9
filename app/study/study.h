// What all studies share: options, tasks that can be run apart from each other, here or on other
// machines, and the way from tasks to a report.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/options.h"
#include "app/study/report.h"
#include "app/study/store.h"

namespace app {

struct StudyOptions {
  CommonOptions common;
  std::vector<std::string> words;  // cases, choices or scenes; empty: all
  std::string methods, severity;
  int steps = 0, repeats = 0;  // 0: as much as `quick` says
  bool quick = false, fresh = false, list = false, table = false;
  bool jobs = false, collect = false;
  std::string run;  // the one task to run

  // The command that this is; `words` in place of its own. Quoted for a shell where it has to be.
  std::string command(const std::string& study, const std::vector<std::string>& words) const;
};

struct StudyTask {
  std::string id;      // a file's name: "pendulum.bdf2"
  std::string word;    // of the command line that has this task
  double seconds = 0;  // a guess; 0: it is known, or nobody knows
};

struct StudyFindings {
  Report report;
  std::string text;  // for standard output
  bool isGood = true;
};

struct Study {
  std::string name;  // "accuracy"
  std::string listing;
  std::vector<StudyTask> tasks;
  int threads = 1;  // more than one only where nothing is timed
  // Runs what is missing of a task, and keeps what it found for the report. False: interrupted.
  std::function<bool(std::size_t task, Store& store)> run;
  std::function<std::string(std::size_t task)> told;  // of a task that is done; null: nothing
  // From the tasks that were run so far. None: interrupted.
  std::function<std::optional<StudyFindings>()> find;
};

// Where `word` names a task's part: InputError with the nearest one where it names none.
ExitCode runStudy(const Study& study, const StudyOptions& options,
                  const std::filesystem::path& folder);

// The studies. All that is named is read before the first run: a mistake in the last must not cost
// hours.
Study accuracyStudy(const StudyOptions& options, const std::filesystem::path& folder);
Study optionStudy(const StudyOptions& options, const std::filesystem::path& folder);
Study effectStudy(const StudyOptions& options, const std::filesystem::path& folder);
Study stabilityStudy(const StudyOptions& options, const std::filesystem::path& folder);

}  // namespace app
