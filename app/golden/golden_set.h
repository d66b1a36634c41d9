// The golden images of one scene: a folder of PNG files and golden.json beside them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/base/progress.h"
#include "app/golden/golden_motion.h"
#include "render/image.h"
#include "scenes/scene.h"

namespace app {

struct GoldenHashes {
  std::string state;    // of the simulation: physics
  std::string picture;  // of what is to be drawn: view
  bool operator==(const GoldenHashes&) const = default;
};

struct GoldenFrame {
  int frame = 0;
  GoldenHashes hashes;
  render::Image image;
};

struct GoldenRecord {
  std::string reason;  // why the images are as they are
  std::map<int, GoldenHashes> frames;
  GoldenMotion motion;
  std::string problem;  // why golden.json cannot be read; empty: it can, or there is none
};

struct GoldenRun {
  std::vector<GoldenFrame> frames;
  GoldenMotion motion;
  std::vector<std::string> bodyNames;  // but for the world
  std::string problem;                 // why the last frames are missing; empty: they are not
};

// Simulates up to the last frame of [golden] and draws those it names. A camera that fits the
// motion fits `bounds`, those of the approved pictures: what differs then is what moved.
GoldenRun drawGoldenFrames(const scenes::Scene& scene,
                           const std::optional<scenes::MotionBounds>& bounds,
                           ProgressMode progress);

std::filesystem::path goldenImage(const std::filesystem::path& folder, int frame);
GoldenRecord readGoldenRecord(const std::filesystem::path& folder);
void writeGoldenRecord(const GoldenRecord& record, const std::filesystem::path& folder);

}  // namespace app
