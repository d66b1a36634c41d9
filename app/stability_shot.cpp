// Draws runs of the stability study.
#include "app/stability_shot.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/build_info.h"
#include "app/open_renderer.h"
#include "app/output_file.h"
#include "render/png.h"

namespace app {

namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 480, kHeight = 320;
constexpr double kInk = 1.6;
constexpr int kBoundsEvery = 10;  // frames

scenes::ViewOptions viewOptions() {
  scenes::ViewOptions options;
  options.aspect = static_cast<double>(kWidth) / kHeight;
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

}  // namespace

void EndPicture::observe(const scenes::Simulation& simulation, bool failed) {
  const bool counts = simulation.frame() % kBoundsEvery == 0 || isLast(simulation);
  if ((counts && !failed) || simulation.frame() == 0) bounds_.include(simulation);
  if (isLast(simulation)) picture_ = scenes::view(simulation, bounds_, viewOptions(), {});
}

bool EndPicture::write(const fs::path& file) const {
  if (!picture_) return false;
  app::write(*openRenderer({kWidth, kHeight, render::Quality::kStandard, ""}), *picture_, file);
  return true;
}

std::vector<StabilityShot> planFailureShots(const StabilityRun& run) {
  std::vector<StabilityShot> shots;
  if (!run.failure || run.status == StabilityRun::Status::kThrew) return shots;
  const std::string hash =
      hashText(run.key.study + "\n" + run.key.method + "\n" + run.key.level + "\n" + run.inputs);
  const bool exists = run.status != StabilityRun::Status::kNotFinite;
  for (int k = -1; k <= 1; ++k) {
    const bool isFrame = run.failure->frame + k >= 0 && run.failure->frame + k < run.frameCount;
    if (!isFrame || (k >= 0 && !exists)) continue;
    const int frame = run.failure->frame + k;
    shots.push_back({fmt::format("shots/{}_{}_{:05}.png", run.key.study, hash.substr(0, 6), frame),
                     fmt::format("{}, {}", kMoments[k + 1], frame)});
  }
  return shots;
}

bool drawFailureShots(const scenes::StabilityCase& study, const std::vector<std::string>& set,
                      const StabilityRun& run, const std::vector<StabilityShot>& shots,
                      const fs::path& folder) {
  const auto isThere = [&](const StabilityShot& shot) { return fs::exists(folder / shot.file); };
  if (std::all_of(shots.begin(), shots.end(), isThere)) return true;
  const int first = std::max(0, run.failure->frame - 1);
  const int last = first + static_cast<int>(shots.size()) - 1;
  const auto renderer = openRenderer({kWidth, kHeight, render::Quality::kStandard, ""});
  scenes::MotionBounds bounds;
  scenes::ViewOptions options = viewOptions();
  options.overlays.contacts = options.overlays.joints = true;
  const auto visit = [&](const scenes::Simulation& simulation, bool) {
    const int frame = simulation.frame();
    if (frame <= first && (frame % kBoundsEvery == 0 || frame == first)) bounds.include(simulation);
    if (frame < first || frame > last) return;
    const auto shot = static_cast<std::size_t>(frame - first);
    write(*renderer, scenes::view(simulation, bounds, options, {}), folder / shots[shot].file);
  };
  std::vector<std::string> cut = set;  // no further than the last picture
  const scenes::Scene scene = scenes::stabilityScene(study, set);
  if (last + 1 < scene.frameCount()) {
    cut.push_back(fmt::format("duration={:.17g}", 1.0 * last / scene.fps));
  }
  return last == 0 || runStability(study, cut, {}, visit).has_value();
}

}  // namespace app
