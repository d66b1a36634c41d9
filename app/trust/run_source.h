// A run that was made some time, somewhere: an output folder, or its trajectory or motion.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/base/progress.h"
#include "app/run/run_record.h"
#include "app/trust/track.h"

namespace app {

struct RunSource {
  std::filesystem::path path;
  std::optional<RunRecord> record;  // of a folder
  std::optional<Track> track;       // of a file; of a folder once it is replayed
  std::optional<scenes::Scene> scene;
  std::string noTrack;  // why there is none

  int frameCount() const;
};

// A folder with a run.json, a trajectory or a motion. `scene`: what it shows; empty: as run.json names it,
// where that is still the same text. Throws InputError.
RunSource openRun(const std::filesystem::path& path, const std::string& scene);

// Simulates the scene of a folder again, as far as the states have the hashes of run.json: what
// another program or machine made stays unknown from there on.
void replay(RunSource& source, int threads, const std::function<void()>& visit);

}  // namespace app
