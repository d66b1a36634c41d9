// Draws a race: every frame with all its panels is one picture of a drawing process.
#include "app/race/race_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "app/base/interrupt.h"
#include "app/commands/exit_code.h"
#include "app/run/draw_apart.h"
#include "app/run/frame_folder.h"
#include "app/run/open_renderer.h"
#include "app/run/provenance.h"
#include "render/film.h"
#include "render/png.h"
#include "scenes/joined.h"
#include "scenes/view/view.h"

namespace app {

namespace {

constexpr float kOutOfSight = 1e3F;  // times what the picture is about: less than a pixel

// The states of a track, one after the other, as a scene that a view can be had of.
class Replay {
 public:
  Replay(const scenes::Scene& scene, const RaceTrack& track)
      : track_(track), simulation_(scene), velocities_(simulation_.world().bodies().velocity) {
    std::fill(velocities_.begin(), velocities_.end(), physics::Velocity{});
  }

  // An engine that gave up stays as it was, and the clock goes on.
  const scenes::Simulation& show(int frame) {
    const auto last = static_cast<int>(track_.poses.size()) - 1;
    if (frame > 0) {
      simulation_.place(track_.poses[static_cast<std::size_t>(std::min(frame, last))], velocities_);
    }
    return simulation_;
  }

 private:
  const RaceTrack& track_;
  scenes::Simulation simulation_;
  std::vector<physics::Velocity> velocities_;
};

// What ours did, or else the first one while it was whole: no camera follows an explosion.
scenes::MotionBounds boundsOf(const Race& race) {
  const auto found = std::find_if(race.tracks.begin(), race.tracks.end(),
                                  [](const RaceTrack& track) { return track.ran(); });
  const bool trusted = found->entry.engine == "dbd" || !found->broke;
  const int frames = trusted ? static_cast<int>(found->poses.size()) : found->broke->frame + 1;
  scenes::MotionBounds bounds;
  Replay replay(race.scene, *found);
  for (int frame = 0; frame < frames; ++frame) bounds.include(replay.show(frame));
  return bounds;
}

// States that are finite may be too far away for single precision.
void dropWhatIsOutOfSight(render::Picture& picture) {
  const float far = kOutOfSight * std::max(1.0F, picture.focusRadius);
  const auto isFar = [&](const render::Vec3f& at) {
    return !((at - picture.focusCenter).norm() < far);
  };
  std::erase_if(picture.instances, [&](const render::Instance& instance) {
    return isFar(instance.position) || !(instance.size.norm() < far);
  });
  std::erase_if(picture.surfaces, [&](const render::Surface& surface) {
    return std::any_of(surface.positions.begin(), surface.positions.end(), isFar);
  });
}

// How long it is stands in the overrides of its scene.
std::string commandOf(const Race& race, const RaceDrawing& drawing, const RaceLayout& layout,
                      const RunRecord& record) {
  std::vector<std::string> engines;
  for (const RaceTrack& track : race.tracks) engines.push_back(track.entry.engine);
  return fmt::format("{} --engines {} --size {}x{} --quality {}", commandOf("race", record),
                     scenes::joined(engines, ","), layout.width, layout.height,
                     qualityName(drawing.quality));
}

// What a drawing process has: all engines at a frame, on one page, into its file.
class RacePainter {
 public:
  RacePainter(const Race& race, const RaceLimits& limits, const RaceDrawing& drawing,
              const RaceLayout& layout, const FrameFolder& folder)
      : race_(race),
        limits_(limits),
        quality_(drawing.quality),
        layout_(layout),
        folder_(folder),
        bounds_(boundsOf(race)),
        record_(makeRecord(race.scene)),
        command_(commandOf(race, drawing, layout, record_)) {}

  void draw(int frame) {
    if (!renderer_) open();
    std::vector<render::Image> images(replays_.size());
    for (std::size_t panel = 0; panel < replays_.size(); ++panel) {
      if (replays_[panel] != nullptr) images[panel] = image(*replays_[panel], frame);
    }
    const render::Page page = racePage(race_, limits_, layout_, frame, std::move(images));
    render::writePng(printer_->print(page), folder_.file(frame), notesOf(record_, frame, command_));
  }

 private:
  void open() {
    renderer_ = openRenderer({layout_.panelWidth, layout_.pictureHeight, quality_, ""});
    printer_ = std::make_unique<render::PagePrinter>();
    for (const RaceTrack& track : race_.tracks) {
      replays_.push_back(track.ran() ? std::make_unique<Replay>(race_.scene, track) : nullptr);
    }
  }

  const render::Image& image(Replay& replay, int frame) {
    scenes::ViewOptions options;
    options.aspect = static_cast<double>(layout_.panelWidth) / layout_.pictureHeight;
    render::Picture picture = scenes::view(replay.show(frame), bounds_, options, {});
    dropWhatIsOutOfSight(picture);
    return drawFrame(*renderer_, frame, {&picture, 1});
  }

  const Race& race_;
  const RaceLimits& limits_;
  const render::Quality quality_;
  const RaceLayout& layout_;
  const FrameFolder& folder_;
  const scenes::MotionBounds bounds_;
  const RunRecord record_;
  const std::string command_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::PagePrinter> printer_;
  std::vector<std::unique_ptr<Replay>> replays_;  // by track; none of what did not run
};

bool drawFrames(const Race& race, const RaceLimits& limits, const RaceDrawing& drawing,
                const RaceLayout& layout, const FrameFolder& folder) {
  Progress progress(drawing.progress, race.scene.name, "drawing", race.frames);
  RacePainter painter(race, limits, drawing, layout, folder);
  std::vector<int> frames(static_cast<std::size_t>(race.frames));
  std::iota(frames.begin(), frames.end(), 0);
  const bool isWhole = drawApart(
      frames, drawing.threads, [&](int frame) { painter.draw(frame); },
      [&] { progress.advance(); });
  if (isWhole) progress.finish();
  return isWhole;
}

}  // namespace

std::string filmRace(const Race& race, const RaceLimits& limits, const RaceDrawing& drawing,
                     const std::filesystem::path& folder) {
  const RaceLayout layout =
      layoutRace(static_cast<int>(race.tracks.size()), drawing.width, drawing.height);
  const FrameFolder frames(folder);
  frames.clear();
  if (!drawFrames(race, limits, drawing, layout, frames)) return "";
  const std::string name = "race_" + race.scene.name + ".mp4";
  render::FilmOptions options;
  options.framesPerSecond = race.scene.fps;
  try {
    render::makeFilm(render::frameFiles(frames.path(), 0, race.frames - 1), folder / name, options);
  } catch (const render::FilmError& error) {
    if (interrupted()) return "";
    throw EnvironmentError(error.what());
  }
  return name;
}

}  // namespace app
