// Simulating and drawing a scene into a folder of frames, or continuing where a run was stopped.
#include "app/run/render_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/base/stopwatch.h"
#include "app/run/chosen_motion.h"
#include "app/run/crew.h"
#include "app/run/frame_folder.h"
#include "app/run/frame_range.h"
#include "app/run/painter.h"
#include "scenes/joined.h"

namespace app {

namespace {

// Frames that cost somebody hours are not ours to delete.
[[noreturn]] void refuse(const FrameFolder& frames, const std::string& why) {
  const int count = frames.count();
  throw scenes::InputError(
      fmt::format("{} holds {} frame{}: {}\nNothing was deleted. --fresh deletes them and draws "
                  "all again; -o DIR draws elsewhere.",
                  frames.path().string(), count, count == 1 ? "" : "s", why));
}

// Takes over what an earlier run of the same inputs knows.
void openFolder(const FrameFolder& frames, const RenderJob& job, RenderResult& result) {
  const std::optional<RunRecord> earlier = readRecord(job.folder);
  if (job.fresh) {
    frames.clear();
  } else if (earlier && earlier->sameFrames(result.record)) {
    const RunRecord asked = std::exchange(result.record, *earlier);
    result.record.sceneText = asked.sceneText;
    result.record.scenePath = asked.scenePath;
    result.record.frames = asked.frames;
  } else if (frames.count() > 0) {
    if (!earlier) refuse(frames, "no readable run.json tells what they show.");
    refuse(frames, fmt::format("of a run that differs in (was -> would be)\n  {}",
                               scenes::joined(differencesOf(*earlier, result.record), "\n  ")));
  }
  frames.removeLeftovers();
}

bool isDrawn(const FrameFolder& frames, const RenderJob& job, int frame) {
  return frames.has(frame, job.renderer.width, job.renderer.height);
}

bool isComplete(const FrameFolder& frames, const RenderJob& job, const RunRecord& record) {
  const bool recorded =
      record.finished && job.frames.back() < static_cast<int>(record.stateHashes.size());
  return recorded && std::all_of(job.frames.begin(), job.frames.end(), [&](int frame) {
           return !record.stateHashes[frame].empty() && isDrawn(frames, job, frame);
         });
}

// One run over the frames that are wanted.
class Drawing {
 public:
  Drawing(const scenes::Scene& scene, const RenderJob& job, const FrameFolder& frames,
          RenderResult& result)
      : job_(job),
        frames_(frames),
        result_(result),
        simulation_(scene),
        checker_(scene),
        motion_(chooseMotion(simulation_, job, result.record)),
        painter_(simulation_, motion_.motion, job, frames, result.record),
        crew_(
            std::min(job.threads, static_cast<int>(job.frames.size())),
            [this](const std::string& task) { return painter_.draw(task); },
            [this](int, const std::string& answer) { take(parseJson(answer)); }) {}

  void run() {
    result_.record.accuracy = Json();
    try {
      if (!fits()) startDrawing();
      if (motion_.isWhole) {
        showAgain();
      } else {
        simulate();
      }
      draw();
    } catch (const CheckFailed& error) {
      result_.end.code = ExitCode::kCheckFailed;
      result_.end.problem = simulation_.scene().name + ": " + error.what();
    }
    result_.record.finished = result_.end.code == ExitCode::kDone;
  }

 private:
  bool fits() const { return scenes::needsMotionBounds(simulation_.scene()); }

  void startDrawing() {
    progress_.emplace(job_.progress, simulation_.scene().name, "rendering",
                      static_cast<int>(job_.frames.size()));
  }

  // Every frame is drawn as soon as it is there, unless the camera has to see all of them first.
  void simulate() {
    const scenes::Scene& scene = simulation_.scene();
    const int frames = framesNeeded(scene, job_);
    if (fits()) simulation_.setThreads(job_.threads);  // nobody draws yet
    Progress stepping(fits() ? job_.progress : ProgressMode::kNone, scene.name, "simulating",
                      frames);
    double seconds = 0;  // of all runs that it took
    const auto members = [&](physics::Archive& a) {
      a(motion_.motion, seconds, simulation_, checker_);
    };
    const int shown = goOn(seconds);
    for (int frame = 0; frame < shown; ++frame) stepping.advance();
    result_.end = play(
        simulation_, frames,
        [&](double stepSeconds) {
          seconds += stepSeconds;
          checker_.observe(simulation_);
          const scenes::Moment moment = simulation_.moment();
          motion_.motion.append(moment);
          motion_.checkpoint->write(members);  // a hundredth of what drawing it takes
          include(moment);
          stepping.advance();
        },
        shown);
    if (result_.end.code == ExitCode::kInterrupted) return motion_.checkpoint->end(members);
    result_.record.addSeconds("simulate", seconds);
    result_.record.addSeconds("checkpoint", motion_.checkpoint->seconds());
    if (fits()) stepping.finish();
    if (result_.end.frames == scene.frameCount()) {
      result_.record.expectations = describeVerdicts(checker_.verdicts());
    }
    commit(motion_, describeMotion(simulation_.scene(), result_.record));
  }

  // Where a run that was stopped had come to. Returns how many frames it leaves.
  int goOn(double& seconds) {
    if (!motion_.state) return 0;
    (*motion_.state)(seconds, simulation_, checker_);
    const int frames = motion_.motion.frames();
    noteGoesOn(simulation_, job_.progress);
    for (int frame = 0; frame < frames; ++frame) include(motion_.motion.moment(frame));
    return frames;
  }

  void showAgain() {
    const Motion& motion = motion_.motion;
    const int frames = std::min(motion.frames(), framesNeeded(simulation_.scene(), job_));
    for (int frame = 0; frame < frames; ++frame) include(motion.moment(frame));
    result_.end.frames = frames;
    result_.record.expectations = motion.about().value("expectations", Json::array());
  }

  void include(const scenes::Moment& moment) {
    bounds_.include(simulation_, simulation_.scene().camera, moment.poses);
    addAccuracy(simulation_.scene(), moment.metrics.accuracy, result_.record.accuracy);
    if (!agreesWithRecord(moment.frame, moment.stateHash) && frames_.count() > 0) {
      refuse(frames_, fmt::format("of a run whose states differ from frame {} on, though scene, "
                                  "settings and program are the same (did an asset change?).",
                                  moment.frame));
    }
    if (!fits()) ask(moment.frame);
    crew_.pump();
  }

  bool agreesWithRecord(int frame, std::uint64_t stateHash) {
    std::vector<std::string>& hashes = result_.record.stateHashes;
    if (static_cast<int>(hashes.size()) <= frame) hashes.resize(frame + 1);
    const std::string now = hexadecimal(stateHash);
    const std::string before = std::exchange(hashes[frame], now);
    return before.empty() || before == now;
  }

  void draw() {
    if (result_.end.code != ExitCode::kInterrupted && fits()) {
      startDrawing();
      for (int frame = 0; frame < result_.end.frames; ++frame) ask(frame);
    }
    if (result_.end.code == ExitCode::kInterrupted || !crew_.finish()) {
      result_.end.code = ExitCode::kInterrupted;
      return crew_.abandon();
    }
    progress_->finish();
  }

  void ask(int frame) {
    if (!std::binary_search(job_.frames.begin(), job_.frames.end(), frame)) return;
    if (frames_.has(frame, job_.renderer.width, job_.renderer.height)) {
      ++result_.kept;
      progress_->advance();
      return;
    }
    ++result_.drawn;
    const int moments = simulation_.scene().film.moments;
    const int last = moments == 1 ? frame : std::min(frame + moments, result_.end.frames) - 1;
    crew_.ask(frame, Painter::task(frame, last, bounds_));
  }

  void take(const Json& seconds) {
    for (const auto& [stage, spent] : seconds.items()) {
      result_.record.addSeconds(stage, spent.get<double>());
    }
    progress_->advance();
  }

  const RenderJob& job_;
  const FrameFolder& frames_;
  RenderResult& result_;
  scenes::Simulation simulation_;
  scenes::Checker checker_;
  ChosenMotion motion_;
  scenes::MotionBounds bounds_;
  Painter painter_;
  std::optional<Progress> progress_;  // of drawing
  Crew crew_;                         // last: its processes begin with the others as they are
};

}  // namespace

void notePicture(const RenderJob& job, const render::Renderer::Info& info, RunRecord& record) {
  record.frames = frameRangeText(job.frames);
  record.picture = describePicture(job.renderer, info, job.view.hud, job.view.overlays);
  if (!job.askedOverlays.empty()) record.picture["asked_overlays"] = job.askedOverlays;
  if (job.view.trustedUntil) record.picture["trusted_until"] = *job.view.trustedUntil;
  if (job.printWidth > 0) record.picture["print_width"] = job.printWidth;
}

RenderResult renderFrames(const scenes::Scene& scene, const RenderJob& job) {
  RenderResult result;
  result.record = makeRecord(scene);
  noteWarnings(result.record);
  const std::optional<render::Renderer::Info> info = askRendererInfo();
  if (!info) {
    result.end.code = ExitCode::kInterrupted;
    return result;
  }
  notePicture(job, *info, result.record);
  const FrameFolder frames(job.folder);
  openFolder(frames, job, result);
  if (!job.keepsMotion && isComplete(frames, job, result.record)) {
    result.kept = static_cast<int>(job.frames.size());
    return result;
  }
  result.record.finished = false;
  writeRecord(result.record, job.folder);
  const Stopwatch watch;
  Drawing(scene, job, frames, result).run();
  result.record.addSeconds("wall", watch.seconds());
  writeRecord(result.record, job.folder);
  return result;
}

}  // namespace app
