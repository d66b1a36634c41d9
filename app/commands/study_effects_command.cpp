// dbd study effects: what each effect costs, and what it changes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/base/gnuplot.h"
#include "app/base/html.h"
#include "app/base/machine.h"
#include "app/base/output_file.h"
#include "app/base/progress.h"
#include "app/commands/study_commands.h"
#include "app/study/study_effects.h"

namespace app {

namespace {

namespace fs = std::filesystem;

// Those of the README's table.
constexpr const char* kScenes[] = {"pendulum",   "chain",        "heavy_chain",   "spinning_tops",
                                   "spring_net", "flag",         "ragdoll_drive", "dominoes",
                                   "pyramid",    "wrecking_ball"};

struct EffectsOptions {
  CommonOptions common;
  std::vector<std::string> scenes;
  int steps = 0, repeats = 0;  // 0: as much as --quick says
  bool quick = false, fresh = false, table = false;
};

StepEffort effortOf(const EffectsOptions& options) {
  StepEffort effort = options.quick ? StepEffort{20, 5, 1.5} : StepEffort{120, 11, 20};
  if (options.steps > 0) effort.steps = options.steps;
  if (options.repeats > 0) effort.repeats = options.repeats;
  return effort;
}

// All are read before the first is measured.
std::vector<std::string> chosenScenes(const EffectsOptions& options) {
  std::vector<std::string> scenes = options.scenes;
  if (scenes.empty()) scenes.assign(std::begin(kScenes), std::end(kScenes));
  std::vector<std::string> names;
  for (const std::string& word : scenes) {
    const std::string name = scenes::readScene(word, options.common.overrides).name;
    for (const std::string& other : names) {
      if (other == name) throw scenes::InputError(word + ": another scene has this name");
    }
    names.push_back(name);
  }
  return scenes;
}

constexpr const char* kHow =
    "<p>Each scene is run from its start as it is, once more without each effect that can be taken "
    "out of it, and with what the program leaves out or nothing calls for: <em>nothing left "
    "out</em> switches off every decision of the program that something cannot matter, "
    "<em>everything on</em> also gives contacts to scenes that have none and the inertia of "
    "spinning bodies to all. The runs take turns; times are those on the processor, medians, and "
    "&plusmn; half the width of the middle half of the repeats. What is off is the state after the "
    "last step: a price that buys nothing is waste, and a scene without one of its effects is "
    "another scene. <a href=\"points.csv\">points.csv</a> has every number.</p>\n";

void writePage(const std::vector<EffectResults>& all, bool plotted, const fs::path& folder) {
  std::string body = fmt::format(
      "<h1>What each effect costs</h1>\n<p class=\"quiet\">{}, {} threads; load average {:.1f}.</p>"
      "\n{}",
      escapeHtml(processorName()), processorCount(), loadAverage(), kHow);
  for (const EffectResults& results : all) body += effectsSection(results, plotted);
  writeFile(folder / "index.html", htmlPage("What each effect costs", body));
}

std::string tableText(const std::vector<EffectResults>& all) {
  std::string text =
      "| scene | effects on | ms/step | saved against everything on |\n|---|---|---|---|\n";
  for (const EffectResults& results : all) text += effectsRow(results);
  return text;
}

ExitCode effects(const EffectsOptions& options) {
  const std::vector<std::string> chosen = chosenScenes(options);
  const fs::path folder = options.common.outputFolder("study_effects");
  makeFolder(folder);
  PointStore store(folder / "points.csv", !options.fresh);
  Progress progress(options.common.progressMode(), "effects", "measuring",
                    static_cast<int>(chosen.size()));
  const bool plotted = !gnuplotVersion().empty();
  std::vector<EffectResults> all;
  std::string summary;
  for (const std::string& word : chosen) {
    std::optional<EffectResults> results =
        measureEffects(word, options.common.overrides, effortOf(options), store);
    if (!results) {
      note("dbd: interrupted; the same command measures what is missing\n");
      return ExitCode::kInterrupted;
    }
    if (plotted) runGnuplot(effectsScript(*results), folder, results->name);
    summary += effectsText(*results);
    all.push_back(std::move(*results));
    writePage(all, plotted, folder);  // so that it can be looked at
    progress.advance();
  }
  progress.finish();
  if (!plotted) note(kNoGnuplot);
  if (options.table) {
    say(tableText(all));
  } else if (!options.common.quiet) {
    say(summary + (folder / "index.html").string() + "\n");
  }
  return ExitCode::kDone;
}

constexpr const char* kEffectsHelp =
    "Measure what each effect costs and what it changes\n\n"
    "Each SCENE is run with and without each effect that can be taken out of it, and with all that "
    "the\n"
    "program leaves out: time of a step, and how far the end is off. Writes points.csv, a picture\n"
    "NAME.svg and NAME.png for each scene, and index.html. What was measured by the same program "
    "from\n"
    "the same files is not measured again: an interrupted study goes on.";

}  // namespace

void addEffectStudy(CLI::App& study, Action& action) {
  auto options = std::make_shared<EffectsOptions>();
  CLI::App* command = study.add_subcommand("effects", kEffectsHelp);
  command->add_option("SCENE", options->scenes, "Names or paths of scenes [those of the README]");
  command->add_flag("--quick", options->quick, "Few steps and repeats: under a minute");
  command->add_flag("--fresh", options->fresh, "Measure everything again");
  command->add_flag("--table", options->table, "Print the README's table");
  command->add_option("--steps", options->steps, "Frames of a run [120, quick 20]")
      ->check(CLI::Range(2, 1'000'000))
      ->type_name("N");
  command->add_option("--repeats", options->repeats, "Runs of each kind [11, quick 5]")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  addOutput(*command, options->common, "out/study_effects");
  addOverrides(*command, options->common);
  command->callback([options, &action] { action = [options] { return effects(*options); }; });
}

}  // namespace app
