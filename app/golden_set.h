// The golden images of one scene: a folder of PNG files and golden.json beside them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/progress.h"
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
};

// Simulates up to the last frame of [golden] and draws those it names.
std::vector<GoldenFrame> drawGoldenFrames(const scenes::Scene& scene, ProgressMode progress);

std::filesystem::path goldenImage(const std::filesystem::path& folder, int frame);
GoldenRecord readGoldenRecord(const std::filesystem::path& folder);  // empty when there is none
void writeGoldenRecord(const GoldenRecord& record, const std::filesystem::path& folder);

}  // namespace app
