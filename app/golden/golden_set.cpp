// The golden images of one scene: a folder of PNG files and golden.json beside them.
#include "app/golden/golden_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/run/open_renderer.h"
#include "app/run/play.h"
#include "app/run/render_run.h"
#include "app/run/run_record.h"
#include "render/picture_hash.h"
#include "scenes/view/view.h"

namespace app {

namespace {

constexpr const char* kFile = "golden.json";

class GoldenDrawing {
 public:
  GoldenDrawing(const scenes::Scene& scene, const scenes::MotionBounds& bounds)
      : simulation_(scene),
        bounds_(bounds),
        renderer_(openRenderer(
            {scene.golden.width, scene.golden.height, render::Quality::kStandard, ""})) {
    options_.hud = scene.golden.hud;
    options_.overlays = scene.overlays;
    options_.aspect = static_cast<double>(scene.golden.width) / scene.golden.height;
  }

  GoldenRun run(int frames) {
    try {
      run_.problem = play(simulation_, frames, [&](double) { visit(); }).problem;
    } catch (const CheckFailed& error) {
      run_.problem = error.what();
    }
    const bool fits = scenes::needsMotionBounds(simulation_.scene());
    run_.motion = recorder_.take(fits ? std::optional(bounds_) : std::nullopt);
    for (physics::BodyId b = 1; b < simulation_.world().bodyCount(); ++b) {
      run_.bodyNames.push_back(simulation_.bodyName(b));
    }
    return std::move(run_);
  }

 private:
  void visit() {
    if (options_.hud) history_.push_back(simulation_.metrics());
    const std::vector<int>& wanted = simulation_.scene().golden.frames;
    const bool isGolden = std::binary_search(wanted.begin(), wanted.end(), simulation_.frame());
    recorder_.observe(simulation_, isGolden);
    if (!isGolden) return;
    const render::Picture picture = scenes::view(simulation_, bounds_, options_, history_);
    run_.frames.push_back(
        {simulation_.frame(),
         {hexadecimal(simulation_.stateHash()), hexadecimal(render::pictureHash(picture))},
         drawFrame(*renderer_, simulation_.frame(), picture)});
  }

  scenes::Simulation simulation_;
  const scenes::MotionBounds& bounds_;
  scenes::ViewOptions options_;
  std::unique_ptr<render::Renderer> renderer_;
  std::vector<scenes::FrameMetrics> history_;
  MotionRecorder recorder_;
  GoldenRun run_;
};

void fillRecord(const Json& json, GoldenRecord& record) {
  record.reason = json.at("reason").get<std::string>();
  for (const Json& frame : json.at("frames")) {
    record.frames[frame.at("frame").get<int>()] = {frame.at("state").get<std::string>(),
                                                   frame.at("picture").get<std::string>()};
  }
  if (json.contains("motion")) record.motion = motionFrom(json["motion"]);  // older ones have none
}

}  // namespace

GoldenRun drawGoldenFrames(const scenes::Scene& scene,
                           const std::optional<scenes::MotionBounds>& bounds,
                           ProgressMode progress) {
  if (scene.golden.frames.empty()) return {};
  const int frames = 1 + scene.golden.frames.back();
  // The camera fits the motion up to the last golden frame: early frames must not cost the whole
  // run.
  const scenes::MotionBounds fitted = bounds ? *bounds : findBounds(scene, frames, progress);
  if (interrupted()) return {};  // the camera has not seen it all
  return GoldenDrawing(scene, fitted).run(frames);
}

std::filesystem::path goldenImage(const std::filesystem::path& folder, int frame) {
  return folder / fmt::format("{:05}.png", frame);
}

GoldenRecord readGoldenRecord(const std::filesystem::path& folder) {
  GoldenRecord record;
  const std::filesystem::path path = folder / kFile;
  if (!std::filesystem::exists(path)) return record;
  try {
    std::ifstream file(path);
    fillRecord(Json::parse(file), record);
  } catch (const Json::exception& error) {
    record = {};
    record.problem = fmt::format("{} cannot be read: {}", path.string(), error.what());
  }
  return record;
}

void writeGoldenRecord(const GoldenRecord& record, const std::filesystem::path& folder) {
  Json frames = Json::array();
  for (const auto& [frame, hashes] : record.frames) {
    frames.push_back({{"frame", frame}, {"state", hashes.state}, {"picture", hashes.picture}});
  }
  const Json json = {
      {"reason", record.reason}, {"frames", frames}, {"motion", toJson(record.motion)}};
  writeFile(folder / kFile, json.dump(2) + "\n");
}

}  // namespace app
