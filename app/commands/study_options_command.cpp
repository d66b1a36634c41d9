// dbd study options: what each choice buys.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/base/html.h"
#include "app/base/machine.h"
#include "app/base/output_file.h"
#include "app/base/progress.h"
#include "app/commands/study_commands.h"
#include "app/study/study_options.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct OptionsOptions {
  CommonOptions common;
  std::vector<std::string> options;
  bool quick = false, fresh = false, list = false;
};

// All are read before the first is measured. `quick` keeps the quick trials.
std::vector<scenes::StudyOption> readOptions(const OptionsOptions& options) {
  std::vector<scenes::StudyOption> result;
  const bool all = options.options.empty();
  for (const std::string& word : all ? scenes::studyOptions() : options.options) {
    scenes::StudyOption option = scenes::readStudyOption(word);
    if (options.quick) {
      std::erase_if(option.trials, [](const scenes::StudyTrial& trial) { return !trial.quick; });
    }
    if (!option.trials.empty()) result.push_back(std::move(option));
  }
  if (result.empty()) throw scenes::InputError("study: nothing to measure");
  return result;
}

fs::path writePage(const std::vector<OptionResult>& results, const fs::path& folder) {
  std::string body = fmt::format(
      "<h1>What each choice buys</h1>\n<p class=\"quiet\">{}, {} threads; load average {:.1f}. "
      "Each "
      "case is run with the choice and without it: the largest error against the case's reference, "
      "and the wall time per simulated second. A ratio above 1 speaks for the choice.</p>\n",
      escapeHtml(processorName()), processorCount(), loadAverage());
  for (const OptionResult& result : results) body += optionSection(result);
  const fs::path page = folder / "index.html";
  writeFile(page, htmlPage("What each choice buys", body));
  return page;
}

ExitCode listOptions(const std::vector<scenes::StudyOption>& options) {
  for (const scenes::StudyOption& option : options) {
    say(fmt::format("{:<24} {}: {} or {}\n", option.name, option.title, option.with.label,
                    option.without.label));
  }
  return ExitCode::kDone;
}

ExitCode studyChoices(const OptionsOptions& options) {
  const std::vector<scenes::StudyOption> all = readOptions(options);
  if (options.list) return listOptions(all);
  const fs::path folder = options.common.outputFolder("study_options");
  makeFolder(folder);
  PointStore store(folder / "points.csv", !options.fresh);
  int total = 0;
  for (const scenes::StudyOption& option : all) total += static_cast<int>(option.trials.size());
  Progress progress(options.common.progressMode(), "options", "measuring", total);
  std::vector<OptionResult> results;
  std::string summary;
  for (const scenes::StudyOption& option : all) {
    OptionResult result{option, {}};
    for (int t = 0; t < static_cast<int>(option.trials.size()); ++t) {
      std::optional<TrialResult> trial = measureTrial(option, t, options.quick, store, folder);
      if (!trial) {
        note("dbd: interrupted; the same command measures what is missing\n");
        return ExitCode::kInterrupted;
      }
      result.trials.push_back(std::move(*trial));
      progress.advance();
    }
    summary += optionText(result);
    results.push_back(std::move(result));
    writePage(results, folder);
  }
  progress.finish();
  if (!options.common.quiet) say(summary + (folder / "index.html").string() + "\n");
  return ExitCode::kDone;
}

constexpr const char* kOptionsHelp =
    "Measure what each choice buys\n\n"
    "Each OPTION is a name of scenes/studies/options, or the path of such a file: one choice, and\n"
    "cases that are run with it and without it. Writes a table of errors and times for each.";

}  // namespace

void addOptionStudy(CLI::App& study, Action& action) {
  auto options = std::make_shared<OptionsOptions>();
  CLI::App* command = study.add_subcommand("options", kOptionsHelp);
  command->add_option("OPTION", options->options, "Names or paths [all]");
  command->add_flag("--quick", options->quick, "Only the quick trials, with few repeats");
  command->add_flag("--fresh", options->fresh, "Measure everything again");
  command->add_flag("--list", options->list, "Name the choices, measure nothing");
  addOutput(*command, options->common, "out/study_options");
  command->callback([options, &action] { action = [options] { return studyChoices(*options); }; });
}

}  // namespace app
