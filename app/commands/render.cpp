// dbd render: simulates a scene, draws its frames and makes a film of them.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <optional>

#include "app/base/console.h"
#include "app/base/interrupt.h"
#include "app/base/shell.h"
#include "app/base/stopwatch.h"
#include "app/commands/commands.h"
#include "app/commands/picture_options.h"
#include "app/run/chosen_motion.h"
#include "app/run/frame_range.h"
#include "app/run/motion.h"
#include "app/run/provenance.h"
#include "app/run/recorded_run.h"
#include "app/run/render_run.h"
#include "app/run/shards.h"
#include "app/take/take_files.h"
#include "app/trust/trust_chart.h"
#include "render/film.h"

namespace app {

namespace {

struct RenderOptions {
  CommonOptions common;
  PictureOptions picture;
  std::string frames, from;  // empty: all of them
  double printWidth = 0;     // cm
  std::vector<std::string> overlays;
  TakeOptions take;
  bool video = false, hud = false, trust = false, fresh = false, resume = false;
  int jobs = 0;  // 0: this process draws
  bool collect = false;
  const CLI::App* line = nullptr;  // as it was given
};

scenes::Overlays chooseOverlays(scenes::Overlays overlays, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word == "contacts") {
      overlays.contacts = true;
    } else if (word == "impulses") {
      overlays.impulses = true;
    } else if (word == "joints") {
      overlays.joints = true;
    } else if (word == "masses") {
      overlays.centresOfMass = true;
    } else if (word == "arms") {
      overlays.arms = true;
    } else if (word == "vectors") {
      overlays.vectors = true;
    } else {
      throw scenes::InputError(fmt::format(
          "--overlays {}: expected contacts, impulses, joints, masses, arms or vectors", word));
    }
  }
  return overlays;
}

RenderJob makeJob(const RenderOptions& options, const scenes::Scene& scene) {
  RenderJob job;
  job.renderer = options.picture.renderer();
  job.view.hud = options.hud;
  job.view.overlays = chooseOverlays(scene.overlays, options.overlays);
  job.view.aspect = static_cast<double>(job.renderer.width) / job.renderer.height;
  const std::string whole = fmt::format("::{}", scene.film.every);
  job.frames = parseFrameRange(options.frames.empty() ? whole : options.frames, scene.frameCount());
  job.askedOverlays = options.overlays;
  job.printWidth = options.printWidth;
  job.folder = options.common.outputFolder(scene.name);
  job.threads = options.common.threadCount();
  job.from = options.from;
  job.keepsMotion = options.take.any();
  job.fresh = options.fresh;
  job.progress = options.common.progressMode();
  return job;
}

// Every S-th frame plays at fps/S, so that the film keeps the pace of the scene, or that of [film].
void makeVideo(const scenes::Scene& scene, const RenderJob& job, RenderResult& result) {
  const std::filesystem::path file = job.folder / (scene.name + ".mp4");
  const int step = job.frames.size() > 1 ? job.frames[1] - job.frames[0] : 1;
  const Json made = {{"file", file.filename().string()},
                     {"first", job.frames.front()},
                     {"last", job.frames.back()},
                     {"step", step}};
  if (result.drawn == 0 && result.record.video == made && std::filesystem::exists(file)) return;
  if (job.progress != ProgressMode::kNone && job.progress != ProgressMode::kJson) {
    note(scene.name + ": making the film\n");
  }
  const Stopwatch watch;
  render::FilmOptions film;
  film.notes = filmNotes(result.record);
  film.framesPerSecond =
      std::max(1, static_cast<int>(std::lround(scene.fps * scene.film.speed / step)));
  try {
    render::makeFilm(
        render::frameFiles(job.folder / "frames", job.frames.front(), job.frames.back(), step),
        file, film);
  } catch (const render::FilmError& error) {
    if (interrupted()) {
      result.end.code = ExitCode::kInterrupted;
      return;
    }
    throw EnvironmentError(error.what());
  }
  result.record.video = made;
  result.record.seconds["film"] = watch.seconds();
  writeRecord(result.record, job.folder);
}

std::string summary(const scenes::Scene& scene, const RenderJob& job, const RenderResult& result) {
  const Json& seconds = result.record.seconds;
  std::string text = fmt::format("{}: {} frames drawn", scene.name, result.drawn);
  if (result.kept > 0) text += fmt::format(", {} kept from before", result.kept);
  text += fmt::format(
      "; simulate {:.2f} s, draw {:.2f} s, write {:.2f} s in {} processes, {:.2f} s in all\n",
      seconds.value("simulate", 0.0), seconds.value("draw", 0.0), seconds.value("write", 0.0),
      job.threads, seconds.value("wall", 0.0));
  for (const Json& verdict : result.record.expectations) {
    text += fmt::format("{:<5} {}\n", verdict.at("holds").get<bool>() ? "ok" : "FAIL",
                        verdict.at("text").get<std::string>());
  }
  text += (job.folder / "frames").string() + "/\n";
  if (result.record.video.is_object()) {
    text += (job.folder / result.record.video.at("file").get<std::string>()).string() + "\n";
  }
  return text;
}

// The scene that is named, or else the one that the motion was made of, with its overrides.
scenes::Scene readScene(const RenderOptions& options, const std::vector<std::string>& overrides) {
  CommonOptions common = options.common;
  common.overrides = overrides;
  if (!common.scene.empty()) return common.readScene();
  if (options.from.empty()) throw scenes::InputError("SCENE or --from F is required");
  const Json about = Motion::open(options.from).about();
  common.scene = about.value("path", "");
  common.overrides = about.value("scene", Json::object()).value("overrides", common.overrides);
  common.overrides.insert(common.overrides.end(), overrides.begin(), overrides.end());
  return common.readScene();
}

std::string commandOf(const Shard& shard, const RenderOptions& options, const RenderJob& job) {
  static const std::vector<std::string> kOwn = {"jobs",  "collect", "frames", "out",
                                                "video", "fresh",   "resume", "quiet"};
  return fmt::format("{} render{} --frames {} -o {} --quiet\n", shellQuoted(programPath()),
                     given(*options.line, kOwn), framesOf(shard, job.frames),
                     shellQuoted(folderOf(shard, job.folder).string()));
}

ExitCode printShards(const RenderOptions& options, const RenderJob& job) {
  const int count = std::min(options.jobs, static_cast<int>(job.frames.size()));
  for (int k = 0; k < count; ++k) say(commandOf({k, count}, options, job));
  return ExitCode::kDone;
}

RenderResult collectShards(const RenderOptions& options, const scenes::Scene& scene,
                           const RenderJob& job) {
  const Collected collected = collectFrames(scene, job);
  RenderResult result = collected.result;
  if (collected.missing.empty()) return result;
  result.end.code = ExitCode::kCheckFailed;
  result.end.problem = "not every frame was drawn; these make the rest:\n";
  for (const Shard& shard : collected.missing) {
    result.end.problem += commandOf(shard, options, job);
  }
  return result;
}

// As a recorded run was drawn, where this one does not say otherwise.
void takeOver(const RunRecord& record, RenderOptions& options) {
  const Json& was = record.picture;
  if (!was.is_object()) return;  // it was simulated only
  PictureOptions& picture = options.picture;
  if (picture.size.empty() && picture.quality.empty()) {
    picture.size = fmt::format("{}x{}", was.value("width", 0), was.value("height", 0));
  }
  if (picture.quality.empty()) picture.quality = was.value("quality", picture.quality);
  if (options.overlays.empty()) {
    options.overlays = was.value("asked_overlays", options.overlays);
  }
  if (options.printWidth == 0) options.printWidth = was.value("print_width", 0.0);
  if (options.frames.empty()) options.frames = record.frames;
  options.hud = options.hud || was.value("hud", false);
}

void refuseTakeOfAShare(const RenderOptions& options) {
  if (!options.take.any() || (options.jobs == 0 && !options.collect)) return;
  throw scenes::InputError(
      "--player and --gltf take the whole motion, and a share of a film has its own: "
      "`dbd simulate` writes them");
}

void sayHash(const RenderResult& result, const RenderJob& job) {
  const std::vector<std::string>& hashes = result.record.stateHashes;
  const bool done = result.end.code == ExitCode::kDone;  // else: of the last frame there is
  say((done ? hashes.at(job.frames.back()) : hashes.back()) + "\n");
}

ExitCode renderScene(RenderOptions options) {
  refuseTakeOfAShare(options);
  std::optional<RunRecord> recorded;
  if (namesRecord(options.common.scene)) {
    recorded = openRecord(options.common.scene);
    takeOver(*recorded, options);
  }
  const auto read = [&](const std::vector<std::string>& overrides) {
    return readScene(options, overrides);
  };
  scenes::Scene scene = read(options.common.overrides);
  RenderJob job = makeJob(options, scene);
  if (recorded && recorded->picture.contains("trusted_until")) {
    job.view.trustedUntil = recorded->picture.at("trusted_until").get<double>();
  }
  if (options.jobs > 0) return printShards(options, job);
  if (options.video) requireFfmpeg("--video");
  if (options.video && scene.background && scene.background->w() < 1) {
    throw scenes::InputError(
        "--video: films are opaque, and the background is transparent; --set background=white");
  }
  std::optional<Trust> trust;
  if (options.trust) {
    const TrustPlan plan = planTrust(read, options.common.overrides);
    scene = plan.scene;  // at the accuracy that is judged
    trust = measureTrust(plan, job.threads, job.progress);
    job.view.hud = true;
    job.view.trustedUntil = trust->until();
  }
  std::optional<TakeFiles> take;
  if (options.take.any()) {
    take.emplace(options.take, scenes::Simulation(scene), framesNeeded(scene, job));
  }
  RenderResult result;
  if (interrupted()) {
    result.end.code = ExitCode::kInterrupted;
  } else {
    result = options.collect ? collectShards(options, scene, job) : renderFrames(scene, job);
  }
  if (result.end.code == ExitCode::kDone && options.video) makeVideo(scene, job, result);
  if (result.end.code == ExitCode::kInterrupted) {
    note("dbd: interrupted; the same command goes on where it stopped\n");
    return result.end.code;
  }
  if (take) {
    const scenes::Simulation start(scene);
    take->write(scene, drawnMotion(start, job), job.view.overlays);
  }
  if (trust) {
    writeTrust(*trust, job.folder);
    drawTrustChart(*trust, job.folder);
  }
  if (trust && !options.common.quiet) say(trustText(*trust));
  if (!options.common.quiet) say(summary(scene, job, result));
  if (options.common.hash) sayHash(result, job);
  if (!result.end.problem.empty()) note("dbd: " + result.end.problem + "\n");
  return result.end.code;
}

void addViewOptions(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--frames", options.frames,
                  "Frames A to B-1 in steps of S, as Python slices; one number is one frame [all]")
      ->type_name("A:B:S");
  addPictureOptions(command, options.picture);
  command
      .add_option("--print-width", options.printWidth,
                  "How wide the pictures will be printed: the files tell it to word processors")
      ->check(CLI::Range(0.1, 1000.0))
      ->type_name("CM");
  command.add_flag("--hud", options.hud, "Show time, counts and running plots in the picture");
  command.add_flag("--trust", options.trust,
                   "Compare with a tenth of the accuracy first, as dbd trust does, and show in the "
                   "HUD where the trust ends");
  command
      .add_option("--overlays", options.overlays,
                  "Draw contacts, impulses, joints, masses, arms, vectors (a list with commas)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LIST");
}

}  // namespace

void addRender(CLI::App& line, Action& action) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = line.add_subcommand("render", "Simulate a scene and draw its frames as PNG");
  addScene(*command, options->common)->required(false);
  command
      ->add_option("--from", options->from,
                   "Draw this motion instead of simulating; SCENE may be left out, or say how it "
                   "looks")
      ->type_name("F.npz");
  command->add_flag("--video", options->video, "Also make DIR/NAME.mp4");
  addViewOptions(*command, *options);
  addTake(*command, options->take);
  CLI::Option* resume = command->add_flag(
      "--resume", options->resume,
      "Keep the frames of an earlier, same run; refuse those of another (the default)");
  command
      ->add_flag("--fresh", options->fresh, "Delete the frames that are there and draw all again")
      ->excludes(resume);
  auto* jobs = command->add_option("--jobs", options->jobs,
                                   "Draw nothing: print N commands, each of which draws its share "
                                   "of the frames into DIR/jobs, anywhere and any number of times");
  jobs->type_name("N")->check(CLI::Range(1, 100000));
  command->add_flag("--collect", options->collect, "Draw nothing: join what jobs drew")
      ->excludes(jobs);
  options->line = command;
  addCommon(*command, options->common);
  addHash(*command, options->common);
  command->callback([options, &action] { action = [options] { return renderScene(*options); }; });
}

}  // namespace app
