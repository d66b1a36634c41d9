// Draws runs of the stability study.
#include "app/study/stability_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "app/base/build_info.h"
#include "app/base/output_file.h"
#include "app/run/open_renderer.h"
#include "render/png.h"

namespace app {

namespace {

namespace fs = std::filesystem;

constexpr int kShotWidth = 480, kShotHeight = 320;
constexpr double kInk = 1.6;
constexpr int kBoundsEvery = 10;      // frames
constexpr double kCloseMargin = 0.5;  // of a close-up

scenes::ViewOptions viewOptions() {
  scenes::ViewOptions options;
  options.aspect = static_cast<double>(kShotWidth) / kShotHeight;
  options.ink = kInk;
  return options;
}

void write(render::Renderer& renderer, const render::Picture& picture, const fs::path& file) {
  makeFolder(file.parent_path());
  render::writePng(renderer.draw(picture), file);
}

bool isLast(const scenes::Simulation& simulation) {
  return simulation.frame() + 1 == simulation.scene().frameCount();
}

constexpr const char* kMoments[] = {"the frame before", "the first bad frame", "the frame after"};

// What the culprits look like, without what is around them; none: nobody is named.
std::optional<render::Picture> closeUp(const scenes::Simulation& simulation,
                                       const StabilityFailure& failure,
                                       scenes::ViewOptions options) {
  scenes::MotionBounds bounds;
  std::istringstream names(failure.bodies);
  for (std::string name; std::getline(names, name, ',');) {
    name.erase(0, name.find_first_not_of(' '));
    if (name != "world") bounds.include(simulation, name);
  }
  if (!(bounds.low.array() <= bounds.high.array()).all()) return std::nullopt;
  options.camera = simulation.scene().camera;
  options.camera->keys.clear();
  options.camera->margin = kCloseMargin;
  return scenes::view(simulation, bounds, options, {});
}

}  // namespace

void EndPicture::observe(const scenes::Simulation& simulation, bool failed) {
  const bool counts = simulation.frame() % kBoundsEvery == 0 || isLast(simulation);
  if ((counts && !failed) || simulation.frame() == 0) bounds_.include(simulation);
  if (isLast(simulation)) picture_ = scenes::view(simulation, bounds_, viewOptions(), {});
}

bool EndPicture::write(const fs::path& file) const {
  if (!picture_) return false;
  app::write(*openRenderer({kShotWidth, kShotHeight, render::Quality::kStandard, ""}), *picture_,
             file);
  return true;
}

std::vector<StabilityShot> planFailureShots(const StabilityRun& run) {
  std::vector<StabilityShot> shots;
  if (!run.failure || run.status == StabilityRun::Status::kThrew) return shots;
  const std::string hash =
      hashText(run.key.study + "\n" + run.key.method + "\n" + run.key.level + "\n" + run.inputs);
  const std::string name = fmt::format("shots/{}_{}", run.key.study, hash.substr(0, 6));
  const int bad = run.failure->frame;
  const bool exists = run.status != StabilityRun::Status::kNotFinite;  // else the last good one
  for (int frame = std::max(0, bad - 1); frame <= std::min(bad + 1, run.frameCount - 1); ++frame) {
    if (frame >= bad && !exists) break;
    shots.push_back({fmt::format("{}_{:05}.png", name, frame),
                     fmt::format("{}, {}", kMoments[frame - bad + 1], frame), frame, false});
  }
  const bool isNamed = !run.failure->bodies.empty() && run.failure->bodies != "world";
  const int close = exists ? bad : bad - 1;
  if (isNamed && close >= 0) {
    shots.push_back({name + "_close.png", fmt::format("{} in frame {}", run.failure->bodies, close),
                     close, true});
  }
  return shots;
}

bool drawFailureShots(const scenes::StabilityCase& study, const std::vector<std::string>& set,
                      const StabilityRun& run, const std::vector<StabilityShot>& shots,
                      const fs::path& folder) {
  const auto isThere = [&](const StabilityShot& shot) { return fs::exists(folder / shot.file); };
  if (std::all_of(shots.begin(), shots.end(), isThere)) return true;
  const int first = shots.front().frame;
  int last = first;
  for (const StabilityShot& shot : shots) last = std::max(last, shot.frame);
  const auto renderer = openRenderer({kShotWidth, kShotHeight, render::Quality::kStandard, ""});
  scenes::MotionBounds bounds;
  scenes::ViewOptions options = viewOptions();
  options.overlays.contacts = options.overlays.joints = true;
  const auto visit = [&](const scenes::Simulation& simulation, bool) {
    const int frame = simulation.frame();
    if (frame <= first && (frame % kBoundsEvery == 0 || frame == first)) bounds.include(simulation);
    for (const StabilityShot& shot : shots) {
      if (shot.frame != frame) continue;
      const auto picture = shot.isClose ? closeUp(simulation, *run.failure, options)
                                        : scenes::view(simulation, bounds, options, {});
      if (picture) write(*renderer, *picture, folder / shot.file);
    }
  };
  StabilityLimits limits;
  limits.mostFrames = last + 1;
  return runStability(study, set, limits, visit).has_value();
}

}  // namespace app
