// The golden images of one scene: a folder of PNG files and golden.json beside them.
#include "app/golden_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "app/interrupt.h"
#include "app/open_renderer.h"
#include "app/output_file.h"
#include "app/play.h"
#include "app/render_run.h"
#include "app/run_record.h"
#include "render/picture_hash.h"
#include "scenes/view.h"

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

  std::vector<GoldenFrame> run(int frames) {
    const std::vector<int>& wanted = simulation_.scene().golden.frames;
    const PlayEnd end = play(simulation_, frames, [&](double) {
      if (options_.hud) history_.push_back(simulation_.metrics());
      if (std::find(wanted.begin(), wanted.end(), simulation_.frame()) != wanted.end()) draw();
    });
    if (!end.problem.empty()) throw CheckFailed(end.problem);
    return std::move(drawn_);
  }

 private:
  void draw() {
    const render::Picture picture = scenes::view(simulation_, bounds_, options_, history_);
    drawn_.push_back(
        {simulation_.frame(),
         {hexadecimal(simulation_.stateHash()), hexadecimal(render::pictureHash(picture))},
         renderer_->draw(picture)});
  }

  scenes::Simulation simulation_;
  const scenes::MotionBounds& bounds_;
  scenes::ViewOptions options_;
  std::unique_ptr<render::Renderer> renderer_;
  std::vector<scenes::FrameMetrics> history_;
  std::vector<GoldenFrame> drawn_;
};

}  // namespace

std::vector<GoldenFrame> drawGoldenFrames(const scenes::Scene& scene, ProgressMode progress) {
  const std::vector<int>& wanted = scene.golden.frames;
  if (wanted.empty()) return {};
  const int frames = 1 + *std::max_element(wanted.begin(), wanted.end());
  // The camera fits the motion up to the last golden frame: early frames must not cost the whole
  // run.
  const scenes::MotionBounds bounds = findBounds(scene, frames, progress);
  if (interrupted()) return {};  // the camera has not seen it all
  return GoldenDrawing(scene, bounds).run(frames);
}

std::filesystem::path goldenImage(const std::filesystem::path& folder, int frame) {
  return folder / fmt::format("{:05}.png", frame);
}

GoldenRecord readGoldenRecord(const std::filesystem::path& folder) {
  GoldenRecord record;
  std::ifstream file(folder / kFile);
  const Json json = Json::parse(file, nullptr, false);
  if (!json.is_object()) return record;
  record.reason = json.value("reason", "");
  for (const Json& frame : json.value("frames", Json::array())) {
    record.frames[frame.value("frame", -1)] = {frame.value("state", ""),
                                               frame.value("picture", "")};
  }
  return record;
}

void writeGoldenRecord(const GoldenRecord& record, const std::filesystem::path& folder) {
  Json frames = Json::array();
  for (const auto& [frame, hashes] : record.frames) {
    frames.push_back({{"frame", frame}, {"state", hashes.state}, {"picture", hashes.picture}});
  }
  const Json json = {{"reason", record.reason}, {"frames", frames}};
  writeFile(folder / kFile, json.dump(2) + "\n");
}

}  // namespace app
