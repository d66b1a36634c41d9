// Draws a race: panels in parallel, frames put together in order on the calling thread.
#include "app/race/race_film.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/interrupt.h"
#include "app/commands/exit_code.h"
#include "app/run/frame_folder.h"
#include "app/run/pipeline.h"
#include "app/run/provenance.h"
#include "app/run/whole_frames.h"
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

bool drawFrames(const Race& race, const RaceLimits& limits, const RaceDrawing& drawing,
                const RaceLayout& layout, const FrameFolder& folder) {
  scenes::ViewOptions options;
  options.aspect = static_cast<double>(layout.panelWidth) / layout.pictureHeight;
  const scenes::MotionBounds bounds = boundsOf(race);
  std::vector<std::unique_ptr<Replay>> replays;
  for (const RaceTrack& track : race.tracks) {
    replays.push_back(track.ran() ? std::make_unique<Replay>(race.scene, track) : nullptr);
  }
  Progress progress(drawing.progress, race.scene.name, "drawing", race.frames);
  std::vector<bool> isDrawn;
  for (const RaceTrack& track : race.tracks) isDrawn.push_back(track.ran());
  WholeFrames pages(std::move(isDrawn));
  const RunRecord record = makeRecord(race.scene);
  const std::string command = commandOf(race, drawing, layout, record);
  render::PagePrinter printer;
  int printed = 0;
  const auto print = [&] {
    for (; printed < race.frames; ++printed) {
      auto images = pages.next();
      if (!images) return;
      const render::Page page = racePage(race, limits, layout, printed, std::move(*images));
      render::writePng(printer.print(page), folder.file(printed),
                       notesOf(record, printed, command));
      progress.advance();
    }
  };
  Pipeline pipeline({layout.panelWidth, layout.pictureHeight, drawing.quality, ""}, drawing.threads,
                    [&](int job, const render::Image& image) { pages.take(job, image); });
  for (int frame = 0; frame < race.frames; ++frame) {
    for (int panel = 0; panel < layout.panels; ++panel) {
      if (interrupted()) return false;
      Replay* const replay = replays[static_cast<std::size_t>(panel)].get();
      if (replay == nullptr) continue;
      render::Picture picture = scenes::view(replay->show(frame), bounds, options, {});
      dropWhatIsOutOfSight(picture);
      pipeline.draw(pages.job(frame, panel), std::move(picture));
    }
    print();
  }
  pipeline.finish();
  print();
  progress.finish();
  return true;
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
