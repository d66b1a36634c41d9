// dbd diverge: where two runs part.
#include "app/trust/diverge.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/base/console.h"
#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/base/parallel.h"
#include "app/commands/commands.h"
#include "app/commands/picture_options.h"
#include "app/trust/side_by_side.h"
#include "app/trust/trust_chart.h"

namespace app {

namespace {

struct DivergeOptions {
  CommonOptions common;  // no scene of its own
  PictureOptions picture;
  std::string a, b, scene;
};

// Makes the states again that only hashes are known of.
void replayBoth(const DivergeOptions& options, RunSource& a, RunSource& b) {
  if (!a.record && !b.record) return;
  const bool both = a.record && b.record;
  if (both && firstDifference(a.record->stateHashes, b.record->stateHashes) < 0) return;
  const int threads = options.common.threadCount();
  Progress progress(options.common.progressMode(), "diverge", "simulating again",
                    (a.scene ? a.frameCount() : 0) + (b.scene ? b.frameCount() : 0));
  RunSource* sources[] = {&a, &b};
  runTasks(2, threads, [&](int k) {
    replay(*sources[k], std::max(1, threads / 2), [&] { progress.advance(); });
    return true;
  });
  if (!interrupted()) progress.finish();
}

// The first frame that differs, with the body that differs most there.
void drawParting(const DivergeOptions& options, const RunSource& a, const RunSource& b,
                 const Divergence& divergence, const std::filesystem::path& folder) {
  const RunSource& shown = a.scene ? a : b;
  if (!shown.scene || divergence.parting.body == 0) return;
  SideBySide sides;
  sides.scene = *shown.scene;
  if (trackNames(scenes::Simulation(sides.scene)) != a.track->names) {
    throw scenes::InputError(
        fmt::format("diverge: {} has other bodies than these runs", sides.scene.path));
  }
  sides.left = &*a.track;
  sides.right = &*b.track;
  sides.leftLabel = a.path.string();
  sides.rightLabel = b.path.string();
  sides.end = a.track->frames.back().time;
  sides.until = a.track->frames[std::max(0, divergence.first - 1)].time;
  sides.endText = fmt::format("the same until t = {:.2f} s", sides.until);
  sides.marked = divergence.first;
  sides.body = divergence.parting.body;
  sides.parting = fmt::format("'{}' differs in {} by {:.3g}", a.track->names[sides.body],
                              divergence.parting.quantity,
                              std::abs(divergence.parting.a - divergence.parting.b));
  drawSideBySide(sides, {options.picture.renderer(), options.common.threadCount()},
                 {divergence.first}, [&](int) { return folder / "parting.png"; });
}

void writeDivergence(const DivergeOptions& options, const RunSource& a, const RunSource& b,
                     const Divergence& divergence) {
  const std::filesystem::path folder = options.common.outputFolder("diverge");
  makeFolder(folder);
  writeFile(folder / "diverge.json", jsonText(divergeJson(a, b, divergence), 1) + "\n");
  for (const char* old : {"difference.csv", "difference.png", "parting.png"}) {
    removeFile(folder / old);
  }
  const bool differ = !divergence.differences.empty();
  if (differ) writeFile(folder / "difference.csv", divergeCsv(a, divergence));
  drawParting(options, a, b, divergence, folder);
  if (differ) {
    writeCharts(fmt::format("{} beside {}", a.path.string(), b.path.string()),
                {divergeChart(divergence.differences)}, folder / "difference.png");
  }
  if (!options.common.quiet) say(folder.string() + "/\n");
}

ExitCode diverge(const DivergeOptions& options) {
  options.picture.renderer();  // a wrong word is told before the runs
  RunSource a = openRun(options.a, options.scene), b = openRun(options.b, options.scene);
  replayBoth(options, a, b);
  if (interrupted()) {
    note("dbd: interrupted; nothing was written\n");
    return ExitCode::kInterrupted;
  }
  const Divergence divergence = compareRuns(a, b);
  if (!options.common.quiet) say(divergeText(a, b, divergence));
  if (divergence.isSame()) return ExitCode::kDone;
  writeDivergence(options, a, b, divergence);
  return ExitCode::kCheckFailed;
}

constexpr const char* kDivergeHelp =
    "Where two runs part: the first frame, body and quantity; exit code 3 when they differ\n\n"
    "A and B are folders of dbd simulate or dbd render, or files of simulate --trajectory or\n"
    "--motion: of two accuracies, machines or versions. Folders are compared by the hashes of "
    "their states; the\n"
    "bodies are found by simulating again what this program gives the same hashes for. Writes\n"
    "diverge.json, difference.csv and .png, and parting.png where the scene is known.";

}  // namespace

void addDiverge(CLI::App& line, Action& action) {
  auto options = std::make_shared<DivergeOptions>();
  CLI::App* command = line.add_subcommand("diverge", kDivergeHelp);
  command->add_option("A", options->a, "A folder with a run.json, a trajectory, or a motion")
      ->required();
  command->add_option("B", options->b, "Another")->required();
  command
      ->add_option("--scene", options->scene,
                   "The scene of both, where it is not of the library: for the bodies of folders, "
                   "and pictures of trajectories")
      ->type_name("SCENE");
  addPictureOptions(*command, options->picture);
  addOutput(*command, options->common, "out/diverge");
  command->callback([options, &action] { action = [options] { return diverge(*options); }; });
}

}  // namespace app
