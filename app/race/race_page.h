// One frame of a race's film: the engines side by side, numbers below each.
#pragma once

#include "app/race/race_verdict.h"
#include "render/page.h"

namespace app {

struct RaceLayout {
  int width = 0, height = 0;  // of the frame [px]
  int panels = 0, panelWidth = 0, pictureHeight = 0;
  int top = 0, gap = 0;  // of the pictures; between panels [px]
  float textSize = 0;    // px

  int left(int panel) const { return gap + panel * (panelWidth + gap); }
};

// Throws InputError where no room is left for the pictures. Height 0: as the width wants it, and
// width 0: as the panels want it.
RaceLayout layoutRace(int panels, int width, int height);

// `images`: by track, empty for one that does not run.
render::Page racePage(const Race& race, const RaceLimits& limits, const RaceLayout& layout,
                      int frame, std::vector<render::Image> images);

}  // namespace app
