// --player and --gltf: files of a run that others open without dbd.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/base/output_file.h"
#include "app/run/motion.h"

namespace app {

struct TakeOptions {
  std::string player, gltf;  // empty: none
  bool any() const { return !player.empty() || !gltf.empty(); }
};

class TakeFiles {
 public:
  // Opened first: a long run must not end in vain. `start`: the scene before its first step. Throws
  // InputError for a name with another ending and for a run that has no room in a file.
  TakeFiles(const TakeOptions& options, const scenes::Simulation& start, int frames);

  // All frames of the motion, which must be the scene's. `shown`: overlays that are switched on at
  // first.
  void write(const scenes::Scene& scene, const Motion& motion, const scenes::Overlays& shown);

 private:
  TakeOptions options_;
  std::optional<OutputFile> player_, gltf_;
};

}  // namespace app
