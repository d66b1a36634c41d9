// A film of two runs side by side, with a bar that ends where they part.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/base/progress.h"
#include "app/trust/track.h"
#include "render/renderer.h"

namespace app {

struct SideBySide {
  scenes::Scene scene;  // whose bodies both have, and how they look
  const Track *left = nullptr, *right = nullptr;
  std::string leftLabel, rightLabel;
  double until = 0, end = 0;  // s: where they part, and the end of the run
  std::string endText;        // of the bar: "trusted until t = 2.43 s"
  int marked = -1;            // the frame from which on the parting is told; -1: none
  physics::BodyId body = 0;   // that parts first, marked from there on; 0: none
  std::string parting;        // a line about it
};

struct SideDrawing {
  render::RendererOptions renderer;  // of the whole picture
  int threads = 1;
  ProgressMode progress = ProgressMode::kNone;
};

// One PNG for each of `frames`, ascending, each written to file(frame). False: interrupted.
bool drawSideBySide(const SideBySide& sides, const SideDrawing& drawing,
                    const std::vector<int>& frames,
                    const std::function<std::filesystem::path(int)>& file);

// FILE from DIR/00000.png and on; every S-th frame plays at fps/S. Throws EnvironmentError. False:
// interrupted.
bool filmFrames(const std::filesystem::path& folder, const std::vector<int>& frames, int fps,
                const std::filesystem::path& file);

}  // namespace app
