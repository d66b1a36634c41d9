// dbd study: the measurements that answer what accuracy costs, what choices and effects are worth,
// and what holds.
#include "app/study/study.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "app/commands/commands.h"

namespace app {

namespace {

constexpr const char* kAccuracyHelp =
    "Measure what accuracy costs in time\n\n"
    "Each CASE is a name (pendulum) of scenes/studies/accuracy, or the path of a case's file. "
    "Sweeps\n"
    "the case's steps, substeps, iterations and methods, other engines among them, and writes "
    "into\n"
    "DIR: points.csv; what accuracy costs at a glance, glance.svg and .png; accuracy asked for\n"
    "against accuracy delivered, asked.csv, asked.svg and .png; work-precision diagrams NAME.svg "
    "and\n"
    "NAME.png, error against the step NAME_h.svg and NAME_h.png, and index.html with everything.";
constexpr const char* kOptionsHelp =
    "Measure what each choice buys\n\n"
    "Each OPTION is a name of scenes/studies/options, or the path of such a file: one choice, and\n"
    "cases that are run with it and without it. Writes a table of errors and times for each.";
constexpr const char* kEffectsHelp =
    "Measure what each effect costs and what it changes\n\n"
    "Each SCENE is run with and without each effect that can be taken out of it, and with all that "
    "the\n"
    "program leaves out: time of a step, and how far the end is off. Writes points.csv, a picture\n"
    "NAME.svg and NAME.png for each scene, and index.html.";
constexpr const char* kStabilityHelp =
    "Run hard cases and say whether they hold\n\n"
    "Each CASE is a name of scenes/studies/stability, or the path of a case's file: a scene whose\n"
    "[[expect]]s are its criterion, solved with the settings of its family. Writes cases.csv, a\n"
    "picture of each end, and index.html into DIR; of what fails the first bad frame, the bodies,\n"
    "the constraint, and the command that draws it. With --severity search also how far each case\n"
    "can be pushed before it fails, by each method: severity.csv and maps map_FAMILY.svg and "
    ".png.\n"
    "Exit code 3: a case fails.";
constexpr const char* kStored =
    "\n\nWhat was run by the same program from the same files is not run again (runs.jsonl): an\n"
    "interrupted study goes on. --jobs prints the commands of its runs, each of which can be "
    "given\n"
    "on any machine that sees DIR, any number of times; --collect joins what they wrote.";

struct StudyCommand {
  const char* name;
  const char* help;
  const char* word;  // what it takes
  const char* words;
  const char* quick;
  Study (*make)(const StudyOptions& options, const std::filesystem::path& folder);
};
constexpr StudyCommand kStudies[] = {
    {"accuracy", kAccuracyHelp, "CASE", "Names or paths of cases [all]",
     "The quick cases with few points: under 3 minutes", accuracyStudy},
    {"options", kOptionsHelp, "OPTION", "Names or paths [all]",
     "Only the quick trials, with few repeats", optionStudy},
    {"effects", kEffectsHelp, "SCENE", "Names or paths of scenes [those of the README]",
     "Few steps and repeats: under a minute", effectStudy},
    {"stability", kStabilityHelp, "CASE", "Names or paths of cases [all]", "Only the quick cases",
     stabilityStudy},
};

void addOwn(CLI::App& command, const std::string& name, StudyOptions& options) {
  if (name == "accuracy") {
    command.add_option("--methods", options.methods, "Only these [all of each case]")
        ->type_name("A,B");
  }
  if (name == "effects") {
    command.add_flag("--table", options.table, "Print the README's table");
    command.add_option("--steps", options.steps, "Frames of a run [120, quick 20]")
        ->check(CLI::Range(2, 1'000'000))
        ->type_name("N");
    command.add_option("--repeats", options.repeats, "Runs of each kind [11, quick 5]")
        ->check(CLI::Range(1, 1000))
        ->type_name("N");
  }
  if (name == "stability") {
    command.add_option("--severity", options.severity, "Find how far each case can be pushed")
        ->check(CLI::IsMember({"search"}))
        ->type_name("search");
  }
  if (name == "accuracy" || name == "effects") addOverrides(command, options.common);
}

void addOne(const StudyCommand& study, CLI::App& parent, Action& action) {
  auto options = std::make_shared<StudyOptions>();
  const std::string name = study.name;
  CLI::App* command = parent.add_subcommand(name, std::string(study.help) + kStored);
  command->add_option(study.word, options->words, study.words);
  command->add_flag("--quick", options->quick, study.quick);
  command->add_flag("--fresh", options->fresh, "Run everything again");
  command->add_flag("--list", options->list, "Name what there is, run nothing");
  addOwn(*command, name, *options);
  auto* jobs = command->add_flag("--jobs", options->jobs, "Print a command a line for its runs");
  auto* run = command->add_option("--run", options->run, "Run only this, as --jobs names it");
  run->type_name("JOB")->excludes(jobs);
  command->add_flag("--collect", options->collect, "Run nothing: join what jobs wrote")
      ->excludes(jobs)
      ->excludes(run);
  addOutput(*command, options->common, "out/study_" + name);
  command->callback([options, &study, &action] {
    action = [options, &study] {
      const std::filesystem::path folder =
          options->common.outputFolder(std::string("study_") + study.name);
      return runStudy(study.make(*options, folder), *options, folder);
    };
  });
}

}  // namespace

void addStudy(CLI::App& line, Action& action) {
  CLI::App* command = line.add_subcommand("study", "Measure methods, choices and stability");
  command->require_subcommand(1);
  for (const StudyCommand& study : kStudies) addOne(study, *command, action);
}

}  // namespace app
