// The panel at the upper left: title, rows of names and values, bars, running plots.
#pragma once

#include <string>

#include "render/canvas.h"
#include "render/picture.h"

namespace render {

// `scale` is pixels per pixel of a picture of 720 lines. The layout depends on the number of
// rows and plots and on the names of curves only, so that nothing moves while a film runs.
void drawHud(Canvas& canvas, const Hud& hud, float scale);

// What a plot's axis spans, and its ends in words.
struct AxisRange {
  float low = 0, high = 1;  // of the values, or of their decimal logarithms
  std::string lowText, highText;
};
AxisRange axisRangeOf(const Plot& plot);

}  // namespace render
