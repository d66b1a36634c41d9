// The golden images of one scene: a folder of PNG files and golden.json beside them.
#include "app/golden/golden_set.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/output_file.h"
#include "app/run/open_renderer.h"
#include "app/run/play.h"
#include "app/run/run_record.h"
#include "render/picture_hash.h"
#include "scenes/moment.h"
#include "scenes/read/file_text.h"
#include "scenes/view/view.h"

namespace app {

namespace {

constexpr const char* kFile = "golden.json";

// Simulates once, and keeps of it what the pictures are of: a camera that fits the motion has to
// know all of it before the first.
class GoldenDrawing {
 public:
  explicit GoldenDrawing(const scenes::Scene& scene) : simulation_(scene) {
    options_.hud = scene.golden.hud;
    options_.overlays = scene.overlays;
    options_.aspect = static_cast<double>(scene.golden.width) / scene.golden.height;
  }

  // False: a signal came before all was known.
  bool simulate(int frames, ProgressMode mode) {
    Progress progress(mode, simulation_.scene().name, "simulating", frames);
    const PlayEnd end = play(simulation_, frames, [&](double) {
      visit();
      progress.advance();
    });
    if (end.code == ExitCode::kInterrupted) return false;
    progress.finish();
    run_.problem = end.problem;
    for (physics::BodyId b = 1; b < simulation_.world().bodyCount(); ++b) {
      run_.bodyNames.push_back(simulation_.bodyName(b));
    }
    return true;
  }

  GoldenRun draw(const std::optional<scenes::MotionBounds>& approved) {
    const scenes::Scene& scene = simulation_.scene();
    const scenes::MotionBounds bounds = approved.value_or(bounds_);
    const bool fits = scenes::needsMotionBounds(scene);
    run_.motion = recorder_.take(fits ? std::optional(bounds) : std::nullopt);
    const auto renderer =
        openRenderer({scene.golden.width, scene.golden.height, render::Quality::kStandard, ""});
    try {
      for (const scenes::Moment& moment : moments_) drawFrame(moment, bounds, *renderer);
    } catch (const CheckFailed& error) {
      run_.problem = error.what();
    }
    return std::move(run_);
  }

 private:
  void visit() {
    if (options_.hud) history_.push_back(simulation_.metrics());
    bounds_.include(simulation_);
    const std::vector<int>& wanted = simulation_.scene().golden.frames;
    const bool isGolden = std::binary_search(wanted.begin(), wanted.end(), simulation_.frame());
    recorder_.observe(simulation_, isGolden);
    if (isGolden) moments_.push_back(simulation_.moment());
  }

  void drawFrame(const scenes::Moment& moment, const scenes::MotionBounds& bounds,
                 render::Renderer& renderer) {
    simulation_.show(moment);
    const auto end = options_.hud ? history_.begin() + moment.frame + 1 : history_.end();
    const render::Picture picture =
        scenes::view(simulation_, bounds, options_, {history_.begin(), end});
    run_.frames.push_back(
        {moment.frame,
         {hexadecimal(simulation_.stateHash()), hexadecimal(render::pictureHash(picture))},
         app::drawFrame(renderer, moment.frame, {&picture, 1})});
  }

  scenes::Simulation simulation_;
  scenes::MotionBounds bounds_;
  scenes::ViewOptions options_;
  std::vector<scenes::FrameMetrics> history_;
  std::vector<scenes::Moment> moments_;  // of the golden frames
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
  GoldenDrawing drawing(scene);
  if (!drawing.simulate(frames, progress)) return {};
  return drawing.draw(bounds);
}

std::filesystem::path goldenImage(const std::filesystem::path& folder, int frame) {
  return folder / fmt::format("{:05}.png", frame);
}

GoldenRecord readGoldenRecord(const std::filesystem::path& folder) {
  GoldenRecord record;
  const std::filesystem::path path = folder / kFile;
  if (!std::filesystem::exists(path)) return record;
  try {
    fillRecord(parseJson(scenes::fileText(path.string()).value_or("")), record);
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
  writeFile(folder / kFile, jsonText(json, 2) + "\n");
}

}  // namespace app
