// dbd study accuracy: what accuracy costs in time, measured on this machine.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "app/base/console.h"
#include "app/base/gnuplot.h"
#include "app/base/interrupt.h"
#include "app/commands/study_commands.h"
#include "app/study/study_accuracy.h"
#include "app/study/study_asked.h"
#include "app/study/study_page.h"
#include "app/study/study_plot.h"
#include "app/study/study_table.h"
#include "scenes/read/value.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using scenes::StudyCase;

struct AccuracyOptions {
  CommonOptions common;
  std::vector<std::string> cases;
  std::string methods;
  bool quick = false, fresh = false, list = false;
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text + ",") {
    if (c != ',') {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  return words;
}

// Only the methods asked for; an unknown word is an error.
void keepMethods(const std::vector<std::string>& wanted, StudyCase& study) {
  if (wanted.empty()) return;
  std::vector<scenes::StudyMethod> methods;
  std::vector<scenes::StudyGrid> grids;
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    if (std::find(wanted.begin(), wanted.end(), study.methods[m].name) == wanted.end()) continue;
    methods.push_back(study.methods[m]);
    grids.push_back(study.grids[m]);
  }
  study.methods = std::move(methods);
  study.grids = std::move(grids);
}

std::vector<std::string> wantedMethods(const AccuracyOptions& options) {
  std::vector<std::string> known, wanted = split(options.methods);
  for (const scenes::StudyMethod& method : scenes::studyMethods()) known.push_back(method.name);
  for (const std::string& word : wanted) {
    if (std::find(known.begin(), known.end(), word) != known.end()) continue;
    throw scenes::InputError(
        fmt::format("--methods: no method '{}'{}", word, scenes::didYouMean(word, known)));
  }
  return wanted;
}

// All are read before the first is measured: a mistake in the last must not cost hours.
std::vector<StudyCase> readCases(const AccuracyOptions& options) {
  const std::vector<std::string> wanted = wantedMethods(options);
  const bool all = options.cases.empty();
  std::vector<StudyCase> cases;
  for (const std::string& word : all ? scenes::studyCases() : options.cases) {
    StudyCase study = scenes::readStudyCase(word);
    if (all && options.quick && !study.quick) continue;
    study.set.insert(study.set.end(), options.common.overrides.begin(),
                     options.common.overrides.end());
    study.duration = scenes::studyScene(study, {}).duration;
    keepMethods(wanted, study);
    for (const StudyCase& other : cases) {
      if (other.name != study.name) continue;
      throw scenes::InputError(fmt::format("{} and {} have the same name", other.path, study.path));
    }
    if (!study.methods.empty()) cases.push_back(std::move(study));
  }
  if (cases.empty()) throw scenes::InputError("study: no case has any of these methods");
  return cases;
}

ExitCode listCases(const std::vector<StudyCase>& cases) {
  for (const StudyCase& study : cases) {
    std::vector<std::string> methods;
    for (const scenes::StudyMethod& method : study.methods) methods.push_back(method.name);
    say(fmt::format("{:<24} {}{}\n{:<24}   {}\n", study.name, study.title,
                    study.quick ? " (quick)" : "", "", fmt::join(methods, " ")));
  }
  return ExitCode::kDone;
}

std::string commandLine(const AccuracyOptions& options) {
  std::string text = "dbd study accuracy";
  for (const std::string& word : options.cases) text += " " + word;
  if (options.quick) text += " --quick";
  if (!options.methods.empty()) text += " --methods " + options.methods;
  for (const std::string& setting : options.common.overrides) text += " --set " + setting;
  return text;
}

ExitCode tellInterrupted() {
  note("dbd: interrupted; the same command measures what is missing\n");
  return ExitCode::kInterrupted;
}

// Diagrams and pictures of a case that was measured. False: interrupted.
bool illustrate(const AccuracyOptions& options, bool hasGnuplot, const fs::path& folder,
                StudyChapter& chapter) {
  const StudyResults& results = *chapter.results;
  chapter.shots = chooseShots(results);
  if (hasGnuplot) drawPlots(results, folder);
  chapter.plotted = hasGnuplot && results.best() != nullptr;
  return !interrupted() && drawShots(results, chapter.shots, folder, options.fresh);
}

void drawAsked(const std::vector<StudyChapter>& chapters, const fs::path& folder) {
  const std::vector<AskedPoint> asked = askedPoints(resultsOf(chapters));
  if (!asked.empty()) runGnuplot(askedScript(asked), folder, "asked");
}

// What all cases say together.
std::string totals(const std::vector<StudyChapter>& chapters) {
  const std::vector<const StudyResults*> results = resultsOf(chapters);
  const std::string asked = askedText(askedPoints(results));
  return (asked.empty() ? "" : asked + "\n") + goalsText(results) + "\n";
}

ExitCode accuracy(const AccuracyOptions& options) {
  std::vector<StudyCase> cases = readCases(options);
  if (options.list) return listCases(cases);
  const ProgressMode progress = options.common.progressMode();
  const fs::path folder = options.common.outputFolder("study_accuracy");
  const bool hasGnuplot = !gnuplotVersion().empty();
  AccuracyStudy accuracy(std::move(cases), folder, options.quick, !options.fresh, progress);
  std::vector<StudyChapter> chapters;
  std::string summary;
  bool allMeasured = true;
  for (int i = 0; i < accuracy.caseCount(); ++i) {
    const StudyEnds ends = accuracy.measure(i);
    StudyChapter chapter{&accuracy.results(i), {}, false, ends.problem};
    if (ends.interrupted || !illustrate(options, hasGnuplot, folder, chapter)) {
      return tellInterrupted();
    }
    allMeasured = allMeasured && ends.problem.empty();
    summary += ends.problem.empty() ? summaryText(*chapter.results) : ends.problem + "\n";
    chapters.push_back(std::move(chapter));
    if (hasGnuplot) drawAsked(chapters, folder);
    writeStudyPage(chapters, commandLine(options), folder);  // so that it can be looked at
  }
  accuracy.finish();
  if (!hasGnuplot) note(kNoGnuplot);
  if (!options.common.quiet)
    say(summary + totals(chapters) + (folder / "index.html").string() + "\n");
  return allMeasured ? ExitCode::kDone : ExitCode::kCheckFailed;
}

constexpr const char* kAccuracyHelp =
    "Measure what accuracy costs in time\n\n"
    "Each CASE is a name (pendulum) of scenes/studies/accuracy, or the path of a case's file. "
    "Sweeps\n"
    "the case's steps, substeps, iterations and methods, other engines among them, and writes "
    "into\n"
    "DIR: points.csv, work-precision diagrams NAME.svg and NAME.png, error against the step\n"
    "NAME_h.svg and NAME_h.png, accuracy asked for against accuracy delivered, asked.csv,\n"
    "asked.svg and asked.png, and index.html with everything. What was measured by the same\n"
    "program from the same files is not measured again: an interrupted study goes on.";

}  // namespace

void addAccuracyStudy(CLI::App& study, Action& action) {
  auto options = std::make_shared<AccuracyOptions>();
  CLI::App* command = study.add_subcommand("accuracy", kAccuracyHelp);
  command->add_option("CASE", options->cases, "Names or paths of cases [all]");
  command->add_flag("--quick", options->quick, "The quick cases with few points: under 3 minutes");
  command->add_option("--methods", options->methods, "Only these [all of each case]")
      ->type_name("A,B");
  command->add_flag("--fresh", options->fresh, "Measure everything again");
  command->add_flag("--list", options->list, "Name the cases and their methods, measure nothing");
  addOutput(*command, options->common, "out/study_accuracy");
  addOverrides(*command, options->common);
  command->callback([options, &action] { action = [options] { return accuracy(*options); }; });
}

}  // namespace app
