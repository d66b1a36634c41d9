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
  bool fresh = false;
};

// What a run leaves behind, in the order the frames come.
struct Recording {
  std::optional<OutputFile> trajectory;
  std::optional<ChosenMotion> motion;
  std::optional<TakeFiles> take;
  std::optional<StepsChart> steps;
  std::vector<scenes::FrameMetrics> metrics;
  std::vector<StageSeconds> seconds;
  std::vector<std::string> hashes;
  double simulateSeconds = 0;

  void archive(physics::Archive& a) {  // what the motion does not tell
    a(seconds, simulateSeconds);
    if (steps) a(*steps);
  }
};

void writeRows(const scenes::Simulation& of, int frame, std::span<const physics::Pose> poses,
               std::span<const physics::Velocity> velocities, Recording& recording) {
  if (!recording.trajectory) return;
  recording.trajectory->write(trajectoryRows(of, frame, poses, velocities));
}

// From where a run that was stopped left off: what it recorded is told by its motion. Returns how
// many frames that is.
int goOn(scenes::Simulation& simulation, scenes::Checker& checker, ProgressMode progress,
         Recording& recording) {
  if (!recording.motion || !recording.motion->state) return 0;
  (*recording.motion->state)(simulation, checker, recording);
  noteGoesOn(simulation, progress);
  const Motion& motion = recording.motion->motion;
  for (int frame = 0; frame < motion.frames(); ++frame) {
    const scenes::Moment moment = motion.moment(frame);
    writeRows(simulation, frame, moment.poses, moment.velocities, recording);
    recording.metrics.push_back(moment.metrics);
    recording.hashes.push_back(hexadecimal(moment.stateHash));
  }
  return motion.frames();
}

PlayEnd playAndRecord(scenes::Simulation& simulation, scenes::Checker& checker, ProgressMode mode,
                      Recording& recording) {
  ChosenMotion* const motion = recording.motion ? &*recording.motion : nullptr;
  const bool isKept = motion != nullptr && motion->checkpoint;
  const auto members = [&](physics::Archive& a) {
    a(motion->motion, simulation, checker, recording);
  };
  const int shown = goOn(simulation, checker, mode, recording);
  Progress progress(mode, simulation.scene().name, "simulating", simulation.scene().frameCount());
  for (int frame = 0; frame < shown; ++frame) progress.advance();
  const PlayEnd end = play(
      simulation, simulation.scene().frameCount(),
      [&](double stepSeconds) {
        const Stopwatch watch;
        const physics::Bodies& bodies = simulation.world().bodies();
        if (motion != nullptr) motion->motion.append(simulation.moment());
        writeRows(simulation, simulation.frame(), bodies.pose, bodies.velocity, recording);
        const double write = watch.seconds();
        recording.metrics.push_back(simulation.metrics());
        recording.hashes.push_back(hexadecimal(simulation.stateHash()));
        recording.seconds.push_back({stepSeconds, 0, 0, write});
        recording.simulateSeconds += stepSeconds;
        checker.observe(simulation);
        if (isKept) motion->checkpoint->pass(members);
        progress.advance();
      },
      shown);
  if (end.code != ExitCode::kInterrupted) {
    progress.finish();
  } else if (isKept) {
    motion->checkpoint->end(members);
  }
  return end;
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
    if (recording.motion && recording.motion->checkpoint) {
      record.addSeconds("checkpoint", recording.motion->checkpoint->seconds());
    }
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
                   const RunRecord& record, const std::filesystem::path& folder,
                   Recording& recording) {
  if (!options.trajectory.empty()) {
    recording.trajectory.emplace(options.trajectory);
    recording.trajectory->write(trajectoryHeader());
  }
  const int frames = start.scene().frameCount();
  if (options.take.any()) recording.take.emplace(options.take, start, frames);
  if (!options.stepsChart.empty()) recording.steps.emplace(start);
  if (!options.motion.empty()) {
    recording.motion.emplace(
        beginMotion(options.motion, start, frames, Motion::Keep::kAll, record, options.fresh));
  } else if (recording.take) {  // written under a temporary name only, and gone at the end
    const std::filesystem::path file = folder / "take.npz";
    recording.motion.emplace(
        ChosenMotion{Motion::create(file, start, frames, Motion::Keep::kContacts), false, {}, {}});
  }
}

void tellInterrupted(const SimulateOptions& options, int frame) {
  const char* goesOn =
      options.motion.empty() ? "nothing was written" : "the same command goes on from there";
  note(fmt::format("dbd: interrupted at frame {}; {}\n", frame, goesOn));
}

ExitCode simulate(const SimulateOptions& options) {
  if (options.trajectory == "-" && options.metrics == "-") {
    throw scenes::InputError("--trajectory - and --metrics -: only one table fits standard output");
  }
  const ProgressMode progressMode = options.common.progressMode();
  const scenes::Scene scene = options.common.readScene();
  requireOwnFiles({{"--trajectory", options.trajectory},
                   {"--metrics", options.metrics},
                   {"--motion", options.motion, true},
                   {"--steps-chart", options.stepsChart, true}},
                  scene.path);
  RunRecord record = makeRecord(scene);
  noteWarnings(record);
  scenes::Simulation simulation(scene);
  simulation.setThreads(options.common.threadCount());
  const std::filesystem::path folder = options.common.outputFolder(scene.name);
  makeFolder(folder);
  Recording recording;
  openRecording(options, simulation, record, folder, recording);
  std::optional<OutputFile> metrics;
  if (!options.metrics.empty()) metrics.emplace(options.metrics);

  scenes::Checker checker(scene);
  const PlayEnd end = playAndRecord(simulation, checker, progressMode, recording);
  if (end.code == ExitCode::kInterrupted) {
    tellInterrupted(options, simulation.frame());
    return end.code;
  }
  if (end.code == ExitCode::kDone) record.expectations = describeVerdicts(checker.verdicts());
  if (metrics) metrics->write(metricsTable(recording.metrics, recording.seconds));
  if (recording.trajectory) recording.trajectory->commit();
  if (!options.motion.empty()) commit(*recording.motion, describeMotion(scene, record));
  if (recording.take) recording.take->write(scene, recording.motion->motion, scene.overlays);
  if (metrics) metrics->commit();
  if (recording.steps) recording.steps->write(options.stepsChart);
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
  command->add_flag("--fresh", options->fresh,
                    "With --motion: begin anew where a run was stopped, instead of going on");
  addTake(*command, options->take);
  addCommon(*command, options->common);
  addHash(*command, options->common);
  command->callback([options, &action] { action = [options] { return simulate(*options); }; });
}

}  // namespace app
