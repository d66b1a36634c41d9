// Simulating and drawing a scene into a folder of frames, or continuing where a run was stopped.
#include "app/run/render_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/base/stopwatch.h"
#include "app/run/frame_folder.h"
#include "app/run/open_renderer.h"
#include "app/run/pipeline.h"
#include "render/png.h"

namespace app {

namespace {

render::Renderer::Info rendererInfo() {
  constexpr int kSide = 16;
  return openRenderer({kSide, kSide, render::Quality::kDraft, ""})->info();
}

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
    result.record = *earlier;
  } else if (frames.count() > 0) {
    if (!earlier) refuse(frames, "no readable run.json tells what they show.");
    refuse(frames, fmt::format("of a run that differs in (was -> would be)\n  {}",
                               fmt::join(differencesOf(*earlier, result.record), "\n  ")));
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

// One run from the first frame to the last one wanted.
class Drawing {
 public:
  Drawing(const scenes::Scene& scene, const RenderJob& job, const FrameFolder& frames,
          const scenes::MotionBounds& bounds)
      : job_(job),
        frames_(frames),
        bounds_(bounds),
        simulation_(scene),
        checker_(scene),
        progress_(job.progress, scene.name, "rendering", static_cast<int>(job.frames.size())),
        pipeline_(job.renderer, job.threads, [this](int frame, const render::Image& image) {
          render::writePng(image, frames_.file(frame));
          progress_.advance();
        }) {}

  void run(RenderResult& result) {
    try {
      playAndDraw(result);
    } catch (const CheckFailed& error) {
      result.end.code = ExitCode::kCheckFailed;
      result.end.problem = simulation_.scene().name + ": " + error.what();
    }
    const bool whole = result.end.frames == simulation_.scene().frameCount();
    if (whole) result.record.expectations = describeVerdicts(checker_.verdicts());
    result.record.finished = result.end.code == ExitCode::kDone;
    result.record.accuracy = Json();
    for (const scenes::FrameMetrics& frame : history_) {
      addAccuracy(simulation_.scene(), frame.accuracy, result.record.accuracy);
    }
    addSeconds(result.record);
  }

 private:
  void playAndDraw(RenderResult& result) {
    result.end = play(simulation_, job_.frames.back() + 1,
                      [&](double stepSeconds) { visit(stepSeconds, result); });
    if (result.end.code == ExitCode::kInterrupted) return pipeline_.abandon();
    pipeline_.finish();
    progress_.finish();
  }

  void visit(double stepSeconds, RenderResult& result) {
    simulateSeconds_ += stepSeconds;
    checker_.observe(simulation_);
    const bool isAccurate = simulation_.scene().settings.accuracy.has_value();
    if (job_.view.hud || isAccurate) history_.push_back(simulation_.metrics());
    const int frame = simulation_.frame();
    const bool same = agreesWithRecord(frame, result.record);
    const bool wanted = std::binary_search(job_.frames.begin(), job_.frames.end(), frame);
    if (!same && frames_.count() > 0) {
      refuse(frames_, fmt::format("of a run whose states differ from frame {} on, though scene, "
                                  "settings and program are the same (did an asset change?).",
                                  frame));
    }
    if (!wanted) return;
    if (isDrawn(frames_, job_, frame)) {
      ++result.kept;
      progress_.advance();
      return;
    }
    ++result.drawn;
    const Stopwatch watch;
    render::Picture picture = scenes::view(simulation_, bounds_, job_.view, history_);
    viewSeconds_ += watch.seconds();
    pipeline_.draw(frame, std::move(picture));
  }

  bool agreesWithRecord(int frame, RunRecord& record) const {
    if (static_cast<int>(record.stateHashes.size()) <= frame) record.stateHashes.resize(frame + 1);
    const std::string now = hexadecimal(simulation_.stateHash());
    const std::string before = std::exchange(record.stateHashes[frame], now);
    return before.empty() || before == now;
  }

  void addSeconds(RunRecord& record) const {
    const DrawSeconds drawing = pipeline_.seconds();
    record.addSeconds("simulate", simulateSeconds_);
    record.addSeconds("view", viewSeconds_);
    record.addSeconds("draw", drawing.draw);
    record.addSeconds("write", drawing.write);
  }

  const RenderJob& job_;
  const FrameFolder& frames_;
  const scenes::MotionBounds& bounds_;
  scenes::Simulation simulation_;
  scenes::Checker checker_;
  std::vector<scenes::FrameMetrics> history_;  // for the HUD
  double simulateSeconds_ = 0, viewSeconds_ = 0;
  Progress progress_;
  Pipeline pipeline_;  // last: its threads use the others
};

}  // namespace

scenes::MotionBounds findBounds(const scenes::Scene& scene, int frames, ProgressMode mode) {
  scenes::MotionBounds bounds;
  if (!scenes::needsMotionBounds(scene)) return bounds;
  scenes::Simulation simulation(scene);
  Progress progress(mode, scene.name, "finding the camera", frames);
  play(simulation, frames, [&](double) {
    bounds.include(simulation);
    progress.advance();
  });
  if (!interrupted()) progress.finish();
  return bounds;
}

RenderResult renderFrames(const scenes::Scene& scene, const RenderJob& job) {
  RenderResult result;
  result.record = makeRecord(scene);
  noteWarnings(result.record);
  result.record.picture =
      describePicture(job.renderer, rendererInfo(), job.view.hud, job.view.overlays);
  if (job.view.trustedUntil) result.record.picture["trusted_until"] = *job.view.trustedUntil;
  const FrameFolder frames(job.folder);
  openFolder(frames, job, result);
  if (isComplete(frames, job, result.record)) {
    result.kept = static_cast<int>(job.frames.size());
    return result;
  }
  result.record.finished = false;
  writeRecord(result.record, job.folder);
  const Stopwatch watch;
  const scenes::MotionBounds bounds = findBounds(scene, scene.frameCount(), job.progress);
  if (scenes::needsMotionBounds(scene)) result.record.addSeconds("camera", watch.seconds());
  if (interrupted()) {
    result.end.code = ExitCode::kInterrupted;
    return result;
  }
  Drawing(scene, job, frames, bounds).run(result);
  result.record.addSeconds("wall", watch.seconds());
  writeRecord(result.record, job.folder);
  return result;
}

}  // namespace app
