// The parts of a chart that need geometry of their own: where a legend covers no curve, markers,
// and curves cut at the frame.
#pragma once

#include <vector>

#include "render/chart.h"

namespace render {

struct LegendPlace {
  Pixel from = Pixel::Zero();  // upper left corner
  Pixel size = Pixel::Zero();
  float above = 0;  // px that the frame gives up at its top because no free place is inside
  float width = 0;  // of the rows above it
};

// The place in the frame where the legend covers nothing of the curves, corners first; rows above
// the frame where there is none.
LegendPlace placeLegend(Canvas& canvas, const Chart& chart, float textSize, const Pixel& from,
                        const Pixel& to, const std::vector<std::vector<Pixel>>& curves);
void drawLegend(Canvas& canvas, const Chart& chart, const LegendPlace& place, float textSize);

void drawMarker(Canvas& canvas, const ChartCurve& curve, const Pixel& at, float textSize);

// The parts of a polyline within the rectangle.
std::vector<std::vector<Pixel>> clipToFrame(const std::vector<Pixel>& points, const Pixel& from,
                                            const Pixel& to);

// True when the segment meets the rectangle.
bool crosses(const Pixel& a, const Pixel& b, const Pixel& from, const Pixel& to);

}  // namespace render
