// dbd race: the same scene in several engines, side by side.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "app/base/console.h"
#include "app/base/output_file.h"
#include "app/commands/commands.h"
#include "app/commands/picture_options.h"
#include "app/race/race_film.h"
#include "app/race/race_run.h"
#include "app/race/race_table.h"
#include "app/run/run_record.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct RaceOptions {
  CommonOptions common;
  std::vector<std::string> engines;
  std::string size, quality = "standard";
  double seconds = 0;
  bool noFilm = false;
};

RaceDrawing drawingOf(const RaceOptions& options) {
  RaceDrawing drawing;
  if (!options.size.empty()) {
    const PictureSize size = parseSize(options.size);
    drawing.width = size.width;
    drawing.height = size.height;
  }
  drawing.quality = parseQuality(options.quality);
  drawing.threads = options.common.threadCount();
  drawing.progress = options.common.progressMode();
  return drawing;
}

// Frames that somebody else drew are not ours to delete.
void requireOwnFolder(const fs::path& folder) {
  if (!fs::exists(folder / "frames") || fs::exists(folder / "race.json")) return;
  throw scenes::InputError(fmt::format(
      "{} holds frames that are not of a race, and nothing was deleted; -o DIR draws elsewhere",
      folder.string()));
}

std::string summary(const Race& race, const RaceLimits& limits, const fs::path& folder,
                    const std::string& film) {
  std::string text = raceTable(race, limits);
  for (const std::string& line : missingRaceEngines()) text += line + "\n";
  text += (folder / "race.json").string() + "\n";
  if (!film.empty()) text += (folder / film).string() + "\n";
  return text;
}

ExitCode race(RaceOptions options) {
  const RaceDrawing drawing = drawingOf(options);
  const std::vector<std::string> engines =
      checkedRaceEngines(options.engines.empty() ? raceEngines() : options.engines);
  if (options.seconds > 0) {
    options.common.overrides.push_back(fmt::format("duration={}", options.seconds));
  }
  const scenes::Scene scene = options.common.readScene();
  const fs::path folder = options.common.outputFolder("race_" + scene.name);
  layoutRace(static_cast<int>(engines.size()), drawing.width, drawing.height);
  if (!options.noFilm) {
    requireFfmpeg("dbd race");
    requireOwnFolder(folder);
  }
  const RaceLimits limits;
  const std::optional<Race> run = runRace(scene, engines, limits, drawing.progress);
  if (!run) return ExitCode::kInterrupted;
  makeFolder(folder);
  writeFile(folder / "race.csv", raceCsv(*run));
  writeFile(folder / "race.json", raceJson(*run, limits, ""));
  std::string film;
  if (!options.noFilm) {
    film = filmRace(*run, limits, drawing, folder);
    if (film.empty()) return ExitCode::kInterrupted;
    writeFile(folder / "race.json", raceJson(*run, limits, film));
  }
  if (!options.common.quiet) say(summary(*run, limits, folder, film));
  return ExitCode::kDone;
}

constexpr const char* kHelp =
    "The same scene in several engines, side by side\n\n"
    "Each engine at its own defaults, on one thread, frame by frame in turn. Overlaps, joint gaps "
    "and\nenergy of all are measured by dbd's own code from their poses. Says who broke first; "
    "writes the\nframes, a film, race.csv and race.json.";

}  // namespace

void addRace(CLI::App& line, Action& action) {
  auto options = std::make_shared<RaceOptions>();
  CLI::App* command = line.add_subcommand("race", kHelp);
  addScene(*command, options->common);
  command
      ->add_option("--engines", options->engines,
                   "dbd, bullet, ode, mujoco (a list with commas) [all that were found]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LIST");
  command->add_option("--seconds", options->seconds, "How long, instead of the scene's duration")
      ->check(CLI::Range(0.01, 1e6))
      ->type_name("S");
  command->add_option("--size", options->size, "Pixels of a frame [640 an engine, by 720]")
      ->type_name("WxH");
  command->add_option("--quality", options->quality, "Effort of drawing [standard]")
      ->type_name("draft|standard|paper");
  command->add_flag("--no-film", options->noFilm, "Numbers only");
  addOutput(*command, options->common, "out/race_NAME");
  addOverrides(*command, options->common);
  command->callback([options, &action] { action = [options] { return race(*options); }; });
}

}  // namespace app
