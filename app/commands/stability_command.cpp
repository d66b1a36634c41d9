// dbd study stability: hard cases, whether they hold, and how far they can be pushed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/base/console.h"
#include "app/base/gnuplot.h"
#include "app/base/output_file.h"
#include "app/commands/study_commands.h"
#include "app/study/stability_map.h"
#include "app/study/stability_page.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct StabilityOptions {
  CommonOptions common;
  std::vector<std::string> cases;
  std::string severity;
  bool quick = false, fresh = false, list = false;
};

// A file that cannot be read fails as a case of that name does.
StabilityResult unread(const std::string& word, const std::string& problem) {
  StabilityResult result;
  result.study.name = fs::path(word).stem().string();
  result.study.title = result.study.name;
  result.problem = problem;
  return result;
}

// Words of the command line must name cases; of the whole catalogue one bad file is one failure.
std::vector<StabilityResult> readCases(const StabilityOptions& options) {
  const bool all = options.cases.empty();
  std::vector<StabilityResult> results;
  for (const std::string& word : all ? scenes::stabilityFiles() : options.cases) {
    try {
      for (scenes::StabilityCase& study : scenes::readStabilityCases(word)) {
        if (options.quick && all && !study.quick) continue;
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

ExitCode listCases(const std::vector<StabilityResult>& results) {
  for (const StabilityResult& result : results) {
    const auto& severity = result.study.severity;
    say(fmt::format("{:<24} {:<12} {}{}{}\n", result.study.name, result.study.family.name,
                    result.problem.empty() ? result.study.title : result.problem,
                    result.study.quick ? " (quick)" : "",
                    severity ? fmt::format("\n{:<24} {:<12}   {}: {:g}, up to {:g}", "", "",
                                           severity->label, severity->stated, severity->to)
                             : ""));
  }
  return ExitCode::kDone;
}

std::string commandLine(const StabilityOptions& options) {
  std::string text = "dbd study stability";
  for (const std::string& word : options.cases) text += " " + word;
  if (options.quick) text += " --quick";
  if (!options.severity.empty()) text += " --severity " + options.severity;
  return text;
}

void drawMaps(const std::vector<StabilityResult>& results, const fs::path& folder) {
  for (const scenes::StabilityFamily& family : familiesOf(results)) {
    const std::string name = "map_" + family.name;
    const std::string script = mapScript(casesOf(results, family.name), family.title, name);
    if (!script.empty()) runGnuplot(script, folder, name);
  }
}

void writeTables(const StabilityStudy& study, const StabilityOptions& options,
                 const fs::path& folder) {
  writeFile(folder / "cases.csv", casesTable(study.results()));
  if (!options.severity.empty()) {
    writeFile(folder / "severity.csv", severityTable(study.results()));
  }
  writeStabilityPage(study.results(), commandLine(options), folder);
}

std::string closing(const StabilityStudy& study) {
  const auto& results = study.results();
  const auto held = std::count_if(results.begin(), results.end(),
                                  [](const StabilityResult& result) { return result.holds(); });
  std::string text;
  for (const StabilityResult& result : results) text += severityText(result);
  text += fmt::format("{} of {} cases hold", held, results.size());
  if (study.reusedRuns() > 0) text += fmt::format("; {} runs were made before", study.reusedRuns());
  return text + "\n";
}

ExitCode stability(const StabilityOptions& options) {
  std::vector<StabilityResult> cases = readCases(options);
  if (options.list) return listCases(cases);
  const fs::path folder = options.common.outputFolder("study_stability");
  const bool searches = !options.severity.empty();
  const bool hasGnuplot = searches && !gnuplotVersion().empty();
  StabilityStudy study(std::move(cases), folder, !options.fresh, options.common.threadCount(),
                       options.common.progressMode());
  const auto tell = [&](const StabilityResult& result) {
    if (!options.common.quiet) say(verdictText(result));
    flushOutput();
  };
  const auto write = [&] {
    writeTables(study, options, folder);
    return true;
  };
  const bool done = study.judge(tell) && study.draw() && write() &&
                    (!searches || (study.search() && study.draw()));
  if (!done) {
    note("dbd: interrupted; the same command runs what is missing\n");
    return ExitCode::kInterrupted;
  }
  if (hasGnuplot) drawMaps(study.results(), folder);
  write();
  if (searches && !hasGnuplot) note(kNoGnuplot);
  if (!options.common.quiet) say(closing(study) + (folder / "index.html").string() + "\n");
  const auto& results = study.results();
  const bool allHold = std::all_of(results.begin(), results.end(),
                                   [](const StabilityResult& result) { return result.holds(); });
  return allHold ? ExitCode::kDone : ExitCode::kCheckFailed;
}

constexpr const char* kStabilityHelp =
    "Run hard cases and say whether they hold\n\n"
    "Each CASE is a name of scenes/studies/stability, or the path of a case's file: a scene whose\n"
    "[[expect]]s are its criterion, solved with the settings of its family. Writes cases.csv, a\n"
    "picture of each end, and index.html into DIR; of what fails the first bad frame, the bodies,\n"
    "the constraint, and the command that draws it. With --severity search also how far each case\n"
    "can be pushed before it fails, by each method: severity.csv and maps map_FAMILY.svg and "
    ".png.\n"
    "What was run by the same program from the same files is not run again. Exit code 3: a case\n"
    "fails.";

}  // namespace

void addStabilityStudy(CLI::App& study, Action& action) {
  auto options = std::make_shared<StabilityOptions>();
  CLI::App* command = study.add_subcommand("stability", kStabilityHelp);
  command->add_option("CASE", options->cases, "Names or paths of cases [all]");
  command->add_option("--severity", options->severity, "Find how far each case can be pushed")
      ->check(CLI::IsMember({"search"}))
      ->type_name("search");
  command->add_flag("--quick", options->quick, "Only the quick cases");
  command->add_flag("--fresh", options->fresh, "Run everything again");
  command->add_flag("--list", options->list, "Name the cases, run nothing");
  addOutput(*command, options->common, "out/study_stability");
  command->callback([options, &action] { action = [options] { return stability(*options); }; });
}

}  // namespace app
