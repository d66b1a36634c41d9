// Opens folders and trajectories, and makes the states of a folder again.
#include "app/trust/run_source.h"

#include <fmt/format.h>

namespace app {

namespace {

namespace fs = std::filesystem;

// The scene that a record names, where its text is what was run.
void findScene(RunSource& source, const std::string& asked) {
  const Json& was = source.record->scene;
  const auto overrides = was.value("overrides", std::vector<std::string>());
  const std::string name = asked.empty() ? was.value("name", "") : asked;
  try {
    scenes::Scene scene = scenes::readScene(name, overrides);
    if (sceneHash(scene) == was.value("text_hash", "")) {
      source.scene = std::move(scene);
    } else {
      source.noTrack = fmt::format("{} is not what it was when this was run", scene.path);
    }
  } catch (const scenes::InputError& error) {
    if (!asked.empty()) throw;
    source.noTrack = fmt::format("no scene '{}' here (--scene FILE names it)", name);
  }
}

}  // namespace

int RunSource::frameCount() const {
  return record ? static_cast<int>(record->stateHashes.size()) : track->frameCount();
}

RunSource openRun(const fs::path& path, const std::string& scene) {
  RunSource source;
  source.path = path;
  if (!fs::exists(path)) throw scenes::InputError("diverge: no file or folder " + path.string());
  if (!fs::is_directory(path)) {
    source.track = path.extension() == ".npz" ? readMotion(path) : readTrajectory(path);
    if (!scene.empty()) source.scene = scenes::readScene(scene);
    return source;
  }
  source.record = readRecord(path);
  if (!source.record) {
    throw scenes::InputError(
        fmt::format("diverge: {} holds no readable run.json: expected a folder of dbd simulate or "
                    "dbd render, or what simulate --trajectory or --motion writes",
                    path.string()));
  }
  if (source.record->stateHashes.empty()) {
    throw scenes::InputError(fmt::format("diverge: {}: no frame was simulated", path.string()));
  }
  findScene(source, scene);
  return source;
}

void replay(RunSource& source, int threads, const std::function<void()>& visit) {
  if (!source.record || !source.scene) return;
  const std::vector<std::string>& hashes = source.record->stateHashes;
  scenes::Simulation simulation(*source.scene);
  simulation.setThreads(threads);
  Track track;
  track.names = trackNames(simulation);
  bool same = true;
  track.end = play(simulation, source.frameCount(), [&](double) {
    const std::string& was = hashes[simulation.frame()];
    same = same && (was.empty() || was == hexadecimal(simulation.stateHash()));
    if (same) track.frames.push_back(trackFrame(simulation));
    visit();
  });
  if (!same) {
    source.noTrack =
        fmt::format("here its scene goes otherwise from frame {} on", track.frameCount());
  }
  source.track = std::move(track);
}

}  // namespace app
