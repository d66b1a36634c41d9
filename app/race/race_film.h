// Draws a race: every frame of every engine through the same camera, side by side, and a film.
#pragma once

#include <filesystem>

#include "app/base/progress.h"
#include "app/race/race_page.h"
#include "render/renderer.h"

namespace app {

struct RaceDrawing {
  int width = 0, height = 0;  // of a frame [px]; 0: as the panels want it
  render::Quality quality = render::Quality::kStandard;
  int threads = 1;
  ProgressMode progress = ProgressMode::kNone;
};

// FOLDER/frames/00000.png and on, and the film; its name. Empty: interrupted. Throws
// EnvironmentError where the film cannot be made.
std::string filmRace(const Race& race, const RaceLimits& limits, const RaceDrawing& drawing,
                     const std::filesystem::path& folder);

}  // namespace app
