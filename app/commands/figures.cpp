// dbd figures: simulates, measures, draws and judges the paper's figures, or a user's own.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/base/stopwatch.h"
#include "app/commands/commands.h"
#include "app/figure/figure_draw.h"
#include "app/figure/figure_record.h"
#include "render/film.h"

namespace app {

namespace {

namespace fs = std::filesystem;

struct FigureOptions {
  CommonOptions common;
  std::vector<std::string> figures;
  std::string quality = "paper";
  int width = 0;
  std::vector<std::string> formats;
  bool fresh = false;
};

struct Wanted {
  std::string asked;
  scenes::FigureSheet sheet;
};

// All are read before the first is made: a mistake in the last must not cost the time of the first.
std::vector<Wanted> readSheets(const FigureOptions& options) {
  std::vector<Wanted> sheets;
  const bool all = options.figures.empty();
  for (const std::string& word : all ? scenes::figureSheets() : options.figures) {
    Wanted wanted{word, scenes::readFigureSheet(word)};
    if (all && wanted.sheet.number > 0) wanted.asked = std::to_string(wanted.sheet.number);
    for (const Wanted& other : sheets) {
      if (other.sheet.name != wanted.sheet.name) continue;
      throw scenes::InputError(fmt::format("{} and {} both make {}", other.sheet.path,
                                           wanted.sheet.path, wanted.sheet.name));
    }
    sheets.push_back(std::move(wanted));
  }
  if (sheets.empty()) throw scenes::InputError("figures: no sheets in scenes/figures");
  return sheets;
}

// One row per run, frame and metric: runs differ in their lengths and metrics.
std::string dataTable(const scenes::FigureSheet& sheet, const std::vector<scenes::Series>& series) {
  std::string table = "run,scene,frame,time,metric,body,value\n";
  for (std::size_t run = 0; run < series.size(); ++run) {
    const scenes::Series& data = series[run];
    for (std::size_t k = 0; k < data.names.size(); ++k) {
      for (std::size_t frame = 0; frame < data.values[k].size(); ++frame) {
        table += fmt::format("{},{},{},{:.17g},{},{},{:.17g}\n", run, sheet.runs[run].scene.name,
                             frame, static_cast<double>(frame) / data.fps, data.names[k].metric,
                             data.names[k].body, data.values[k][frame]);
      }
    }
  }
  return table;
}

class FigureMaker {
 public:
  FigureMaker(const FigureOptions& options, const Wanted& wanted, const fs::path& folder)
      : options_(options),
        sheet_(wanted.sheet),
        folder_(folder),
        plan_(planFigure(sheet_, options.width)),
        record_(makeFigureRecord(sheet_, wanted.asked, parseQuality(options.quality),
                                 plan_.page.width)) {
    drawing_ = {parseQuality(options.quality), options.common.threadCount(),
                options.common.progressMode(), options.formats};
  }

  // True when the folder holds it already, made from the same.
  bool isThere() {
    if (options_.fresh) return false;
    const std::optional<FigureRecord> earlier = readFigureRecord(file(".json"));
    if (!earlier || earlier->inputs != record_.inputs) return false;
    for (const std::string& format : drawing_.formats) {
      const Json file = sheet_.name + "." + format;
      if (std::find(earlier->files.begin(), earlier->files.end(), file) == earlier->files.end()) {
        return false;
      }
    }
    record_ = *earlier;
    return true;
  }

  bool make() {  // false: interrupted
    const Stopwatch wall;
    Stopwatch watch;
    removeFile(file(".json"));  // until the figure is whole again, nothing vouches for its files
    FigureShots shots = simulateFigure(plan_, drawing_.progress);
    if (shots.interrupted) return false;
    record_.seconds["simulate"] = watch.lap();
    record_.problem = shots.problem;
    if (shots.problem.empty()) {
      if (!draw(shots, watch)) return false;
      judgeAll(shots);
    }
    record_.seconds["all"] = wall.seconds();
    writeFigureRecord(record_, folder_);
    return true;
  }

  const FigureRecord& record() const { return record_; }

 private:
  fs::path file(const char* ending) const { return folder_ / (sheet_.name + ending); }

  bool draw(FigureShots& shots, Stopwatch& watch) {
    if (!drawFigure(plan_, shots, drawing_, file(".png"))) return false;
    record_.files.push_back(sheet_.name + ".png");
    for (const std::string& format : drawing_.formats) {
      record_.files.push_back(sheet_.name + "." + format);
    }
    record_.seconds["draw"] = watch.lap();
    writeFile(file(".csv"), dataTable(sheet_, shots.series));
    record_.files.push_back(sheet_.name + ".csv");
    if (plan_.filmTiles.empty()) return true;
    if (render::ffmpegVersion().empty()) {
      note(
          fmt::format("dbd: {}: no film: cannot run ffmpeg; install it with: sudo apt-get install "
                      "-y ffmpeg\n",
                      sheet_.name));
      return true;
    }
    if (!filmFigure(plan_, shots, drawing_, folder_ / sheet_.name, file(".mp4"))) return false;
    record_.files.push_back(sheet_.name + ".mp4");
    record_.seconds["film"] = watch.lap();
    return true;
  }

  void judgeAll(const FigureShots& shots) {
    for (const scenes::FigureMeasure& measure : sheet_.measures) {
      addVerdict(scenes::judge(measure, sheet_, shots.series), record_);
    }
  }

  const FigureOptions& options_;
  const scenes::FigureSheet& sheet_;
  const fs::path folder_;
  const FigurePlan plan_;
  FigureRecord record_;
  FigureDrawing drawing_;
};

std::string summary(const FigureRecord& record, bool wasThere) {
  const double seconds = record.seconds.value("all", 0.0);
  std::string text = fmt::format("{}: {}, {}\n", record.name, record.title,
                                 wasThere ? "unchanged" : fmt::format("made in {:.1f} s", seconds));
  for (const Json& measure : record.measures) {
    text += fmt::format("  {:<5} {}: {} {}\n", measure.value("holds", false) ? "ok" : "FAIL",
                        measure.value("text", ""), measure.value("measured", ""),
                        measure.value("bound", ""));
  }
  if (!record.problem.empty()) text += "  FAIL  " + record.problem + "\n";
  return text;
}

ExitCode figures(const FigureOptions& options) {
  const std::vector<Wanted> sheets = readSheets(options);
  const fs::path folder(options.common.folder.empty() ? "out" : options.common.folder);
  makeFolder(folder);
  bool allHold = true;
  for (const Wanted& wanted : sheets) {
    FigureMaker maker(options, wanted, folder);
    const bool wasThere = maker.isThere();
    if (!wasThere && !maker.make()) {
      note("dbd: interrupted; the same command makes what is missing\n");
      return ExitCode::kInterrupted;
    }
    allHold = allHold && maker.record().holds();
    if (!options.common.quiet) say(summary(maker.record(), wasThere));
    writeFigurePage(folder);  // after each, so that those that are made can be looked at
  }
  if (!options.common.quiet) say((folder / "index.html").string() + "\n");
  return allHold ? ExitCode::kDone : ExitCode::kCheckFailed;
}

constexpr const char* kFiguresHelp =
    "Make the figures of the paper, or your own\n\n"
    "Each FIGURE is a number (7), a name (axle) or the path of a sheet; without any, all that are\n"
    "shipped in scenes/figures. Into DIR go figure01.png and its data figure01.csv, where it "
    "moves\n"
    "also figure01.mp4 and its frames, and index.html with what was claimed and what was "
    "measured.\n"
    "What has not changed is not made again. Exit code 3: a measure does not hold.";

}  // namespace

void addFigures(CLI::App& line, Action& action) {
  auto options = std::make_shared<FigureOptions>();
  CLI::App* command = line.add_subcommand("figures", kFiguresHelp);
  command->add_option("FIGURE", options->figures, "Numbers, names or paths of sheets [all]");
  command->add_option("--quality", options->quality, "Effort of drawing [paper]")
      ->type_name("draft|standard|paper");
  constexpr int kLeast = 200, kMost = 8000;
  command->add_option("--width", options->width, "Width in pixels [the sheet's, 2050: 174 mm]")
      ->check(CLI::Range(kLeast, kMost))
      ->type_name("PIXELS");
  command
      ->add_option("--format", options->formats,
                   "Also as vectors, 174 mm wide, with the pictures inside: pdf, svg (a list with "
                   "commas)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"pdf", "svg"}))
      ->type_name("pdf|svg");
  command->add_flag("--fresh", options->fresh, "Make them again, changed or not");
  addOutput(*command, options->common, "out");
  command->callback([options, &action] { action = [options] { return figures(*options); }; });
}

}  // namespace app
