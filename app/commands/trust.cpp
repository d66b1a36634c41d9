// dbd trust: how long a simulation is true.
#include "app/trust/trust.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/base/output_file.h"
#include "app/commands/commands.h"
#include "app/commands/picture_options.h"
#include "app/run/frame_folder.h"
#include "app/run/frame_range.h"
#include "app/trust/side_by_side.h"
#include "app/trust/trust_chart.h"

namespace app {

namespace {

struct TrustOptions {
  CommonOptions common;
  PictureOptions picture;
  std::string frames = ":";
  bool video = false, noFilm = false;
};

SideBySide sidesOf(const Trust& trust) {
  SideBySide sides;
  sides.scene = trust.plan.scene;
  sides.left = &trust.track;
  sides.right = &trust.finer;
  sides.leftLabel = fmt::format("accuracy {:g}", trust.plan.accuracy);
  sides.rightLabel = fmt::format("accuracy {:g}", trust.plan.accuracy / 10);
  if (trust.plan.every > 1) sides.rightLabel += fmt::format(", {} fps", trust.plan.finer.fps);
  sides.until = trust.until();
  sides.end = trust.differences.back().time;
  sides.endText = trust.isWhole() ? "trusted to the end"
                                  : fmt::format("trusted until t = {:.2f} s", trust.until());
  if (trust.isWhole()) return sides;
  sides.marked = trust.beyond;
  sides.body = trust.differences[trust.beyond].body;
  sides.parting = "first apart: " + partingText(trust);
  return sides;
}

// The frames that were asked for and are there, and the one at which they part.
ExitCode drawTrust(const TrustOptions& options, const Trust& trust,
                   const std::filesystem::path& folder) {
  const SideBySide sides = sidesOf(trust);
  SideDrawing drawing{options.picture.renderer(), options.common.threadCount(),
                      options.common.progressMode()};
  const bool isDrawn = options.noFilm || trust.isWhole() ||
                       drawSideBySide(sides, {drawing.renderer, drawing.threads}, {trust.beyond},
                                      [&](int) { return folder / "parting.png"; });
  if (!isDrawn) return ExitCode::kInterrupted;
  if (options.noFilm) return ExitCode::kDone;
  std::vector<int> frames = parseFrameRange(options.frames, trust.plan.scene.frameCount());
  std::erase_if(frames, [&](int frame) { return frame >= trust.frames(); });
  const FrameFolder film(folder);
  film.clear();
  const auto file = [&](int frame) { return film.file(frame); };
  if (frames.empty()) return ExitCode::kDone;
  if (!drawSideBySide(sides, drawing, frames, file)) return ExitCode::kInterrupted;
  if (!options.video) return ExitCode::kDone;
  const bool isFilmed = filmFrames(film.path(), frames, trust.plan.scene.fps,
                                   folder / (trust.plan.scene.name + ".mp4"));
  return isFilmed ? ExitCode::kDone : ExitCode::kInterrupted;
}

ExitCode measureAndShow(const TrustOptions& options) {
  const TrustPlan plan = planTrust(
      [&](const std::vector<std::string>& overrides) {
        CommonOptions common = options.common;
        common.overrides = overrides;
        return common.readScene();
      },
      options.common.overrides);
  options.picture.renderer();                                // a wrong word is told before the runs
  parseFrameRange(options.frames, plan.scene.frameCount());  // and so is a wrong range
  if (options.video) requireFfmpeg("--video");
  const std::filesystem::path folder = options.common.outputFolder("trust_" + plan.scene.name);
  makeFolder(folder);
  const Trust trust =
      measureTrust(plan, options.common.threadCount(), options.common.progressMode());
  if (trust.code != ExitCode::kInterrupted) {
    writeTrust(trust, folder);
    if (!options.common.quiet) say(trustText(trust));
    flushOutput();
  }
  const ExitCode drawn =
      trust.code == ExitCode::kInterrupted ? trust.code : drawTrust(options, trust, folder);
  if (trust.code != ExitCode::kInterrupted) drawTrustChart(trust, folder);
  if (drawn == ExitCode::kInterrupted) {
    note("dbd: interrupted; frames and tables that are there are whole\n");
    return drawn;
  }
  if (!options.common.quiet) say(folder.string() + "/\n");
  if (!trust.problem.empty()) note("dbd: " + trust.problem + "\n");
  return trust.code;
}

constexpr const char* kTrustHelp =
    "How long a simulation is true: the scene at its accuracy beside a tenth of it\n\n"
    "Tells the time until which no body differs by more than the accuracy, relative to the size "
    "of\n"
    "what it is joined to, the body that parts first, and the contact or impact there; writes\n"
    "trust.json, difference.csv and .png, and frames of both side by side, into out/trust_NAME.\n"
    "A scene that states no accuracy gets 1e-2.";

}  // namespace

void addTrust(CLI::App& line, Action& action) {
  auto options = std::make_shared<TrustOptions>();
  CLI::App* command = line.add_subcommand("trust", kTrustHelp);
  addScene(*command, options->common);
  command->add_option("--frames", options->frames, "Frames to draw, as of render [all]")
      ->type_name("A:B:S");
  addPictureOptions(*command, options->picture);
  CLI::Option* video = command->add_flag("--video", options->video, "Also make DIR/NAME.mp4");
  command->add_flag("--no-film", options->noFilm, "Draw no frames: lines, tables and chart only")
      ->excludes(video);
  addOutput(*command, options->common, "out/trust_NAME");
  addOverrides(*command, options->common);
  command->callback(
      [options, &action] { action = [options] { return measureAndShow(*options); }; });
}

}  // namespace app
