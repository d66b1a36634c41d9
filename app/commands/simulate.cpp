// dbd simulate: steps a scene without drawing, and writes what it measured.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>

#include "app/base/console.h"
#include "app/base/csv.h"
#include "app/base/output_file.h"
#include "app/commands/commands.h"
#include "app/run/chosen_motion.h"
#include "app/run/play.h"
#include "app/run/run_record.h"
#include "app/take/take_files.h"
#include "app/trust/steps_chart.h"

namespace app {

namespace {

struct SimulateOptions {
  CommonOptions common;
  std::string trajectory, metrics, motion, stepsChart;
  TakeOptions take;
};

// What a run leaves behind, in the order the frames come.
struct Recording {
  std::optional<OutputFile> trajectory;
  std::optional<Motion> motion;
  std::optional<TakeFiles> take;
  std::vector<scenes::FrameMetrics> metrics;
  std::vector<StageSeconds> seconds;
  std::vector<std::string> hashes;
  double simulateSeconds = 0;
};

PlayEnd playAndRecord(scenes::Simulation& simulation, scenes::Checker& checker, Progress& progress,
                      Recording& recording) {
  return play(simulation, simulation.scene().frameCount(), [&](double stepSeconds) {
    const Stopwatch watch;
    if (recording.trajectory) recording.trajectory->write(trajectoryRows(simulation));
    if (recording.motion) recording.motion->append(simulation.moment());
    const double write = watch.seconds();
    recording.metrics.push_back(simulation.metrics());
    recording.hashes.push_back(hexadecimal(simulation.stateHash()));
    recording.seconds.push_back({stepSeconds, 0, 0, write});
    recording.simulateSeconds += stepSeconds;
    checker.observe(simulation);
    progress.advance();
  });
}

// Frames that an earlier render left in the folder stay good when the states are the same.
void writeRunRecord(const scenes::Scene& scene, RunRecord record, const Recording& recording,
                    const PlayEnd& end, const std::filesystem::path& folder) {
  const std::optional<RunRecord> earlier = readRecord(folder);
  const Json expectations = record.expectations;
  if (earlier && earlier->sameStates(record) && !earlier->picture.is_null()) record = *earlier;
  record.stateHashes = recording.hashes;
  record.accuracy = Json();
  for (const scenes::FrameMetrics& frame : recording.metrics) {
    addAccuracy(scene, frame.accuracy, record.accuracy);
  }
  if (record.picture.is_null()) {
    record.seconds = {{"simulate", recording.simulateSeconds}};
    record.finished = end.code == ExitCode::kDone;
  }
  if (end.code == ExitCode::kDone) record.expectations = expectations;
  writeRecord(record, folder);
}

std::string summary(const scenes::Scene& scene, const Recording& recording) {
  const scenes::FrameMetrics& last = recording.metrics.back();
  const auto frames = recording.metrics.size();
  std::string text = fmt::format("{}: {} frames, {:g} s simulated in {:.2f} s", scene.name, frames,
                                 last.time, recording.simulateSeconds);
  if (frames > 1) {
    text += fmt::format(" ({:.3f} ms per frame)",
                        1e3 * recording.simulateSeconds / static_cast<double>(frames - 1));
  }
  text += fmt::format("\nenergy {:.6g} J ({:.6g} J at the start), overlap {:.3g} m, contacts {}\n",
                      last.total, recording.metrics.front().total, last.overlap, last.contacts);
  for (const physics::KindError& error : last.errors) {
    text += fmt::format("{}: largest error {:.3g} {}\n", error.kind, error.largest, error.unit);
  }
  return text;
}

void tell(const SimulateOptions& options, const scenes::Scene& scene, const Recording& recording) {
  const bool tableOnStdout = options.trajectory == "-" || options.metrics == "-";
  if (!options.common.quiet) {
    (tableOnStdout ? note : say)(summary(scene, recording));
  }
  if (options.common.hash) say(recording.hashes.back() + "\n");
}

// Opened first: a long run must not end in vain.
void openRecording(const SimulateOptions& options, const scenes::Simulation& start,
                   const std::filesystem::path& folder, Recording& recording) {
  if (!options.trajectory.empty()) {
    recording.trajectory.emplace(options.trajectory);
    recording.trajectory->write(trajectoryHeader());
  }
  const int frames = start.scene().frameCount();
  if (options.take.any()) recording.take.emplace(options.take, start, frames);
  if (!options.motion.empty()) {
    recording.motion.emplace(Motion::create(options.motion, start, frames, Motion::Keep::kAll));
  } else if (recording.take) {  // written under a temporary name only, and gone at the end
    const std::filesystem::path file = folder / "take.npz";
    recording.motion.emplace(Motion::create(file, start, frames, Motion::Keep::kContacts));
  }
}

ExitCode simulate(const SimulateOptions& options) {
  if (options.trajectory == "-" && options.metrics == "-") {
    throw scenes::InputError("--trajectory - and --metrics -: only one table fits standard output");
  }
  const ProgressMode progressMode = options.common.progressMode();
  const scenes::Scene scene = options.common.readScene();
  RunRecord record = makeRecord(scene);
  noteWarnings(record);
  scenes::Simulation simulation(scene);
  simulation.setThreads(options.common.threadCount());
  std::optional<StepsChart> steps;
  if (!options.stepsChart.empty()) steps.emplace(simulation);
  const std::filesystem::path folder = options.common.outputFolder(scene.name);
  makeFolder(folder);
  Recording recording;
  openRecording(options, simulation, folder, recording);
  std::optional<OutputFile> metrics;
  if (!options.metrics.empty()) metrics.emplace(options.metrics);

  scenes::Checker checker(scene);
  Progress progress(progressMode, scene.name, "simulating", scene.frameCount());
  const PlayEnd end = playAndRecord(simulation, checker, progress, recording);
  if (end.code == ExitCode::kInterrupted) {
    note(fmt::format("dbd: interrupted at frame {}; nothing was written\n", simulation.frame()));
    return end.code;
  }
  progress.finish();
  if (end.code == ExitCode::kDone) record.expectations = describeVerdicts(checker.verdicts());
  if (metrics) metrics->write(metricsTable(recording.metrics, recording.seconds));
  if (recording.trajectory) recording.trajectory->commit();
  if (!options.motion.empty()) recording.motion->commit(describeMotion(scene, record));
  if (recording.take) recording.take->write(scene, *recording.motion, scene.overlays);
  if (metrics) metrics->commit();
  if (steps) steps->write(options.stepsChart);
  writeRunRecord(scene, record, recording, end, folder);
  tell(options, scene, recording);
  if (!end.problem.empty()) note("dbd: " + end.problem + "\n");
  return end.code;
}

}  // namespace

void addSimulate(CLI::App& line, Action& action) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = line.add_subcommand("simulate", "Step a scene without drawing");
  addScene(*command, options->common);
  command
      ->add_option("--trajectory", options->trajectory,
                   "Table of every body in every frame; - is standard output")
      ->type_name("F.csv");
  command
      ->add_option("--motion", options->motion,
                   "The whole motion, for `dbd render --from` and for numpy.load")
      ->type_name("F.npz");
  command
      ->add_option("--metrics", options->metrics,
                   "Table of energies, momenta, errors and times per frame; - is standard output")
      ->type_name("F.csv");
  command
      ->add_option("--steps-chart", options->stepsChart,
                   "Chart of the steps that islands take by the accuracy, over time")
      ->type_name("F.png");
  addTakeOptions(*command, options->take);
  addCommon(*command, options->common);
  addHash(*command, options->common);
  command->callback([options, &action] { action = [options] { return simulate(*options); }; });
}

}  // namespace app
