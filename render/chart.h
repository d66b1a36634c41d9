// A plot for print: curves over axes with ticks at round numbers and a legend that keeps off the
// data. Plain data in, strokes on a Canvas out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/canvas.h"

namespace render {

struct ChartAxis {
  std::string title;  // with its unit: "angle [rad]"
  bool logarithmic = false;
  std::optional<double> low, high;  // absent: as the data want
  bool holdsLess = false;           // logarithmic: at `low` stands what is less, too
};

enum class Marker { kNone, kCircle, kSquare, kTriangle, kDiamond };

struct ChartCurve {
  std::string name;  // empty: not in the legend
  std::vector<Eigen::Vector2d> points;
  Color color{0, 0, 0, 1};
  bool line = true, dashed = false;
  Marker marker = Marker::kNone;
};

struct Chart {
  ChartAxis x, y;
  std::vector<ChartCurve> curves;  // later ones are drawn over earlier ones
};

// Between the two corners [px]; `textSize` is the height of a line of text [px], all else follows
// from it. Points that are not finite, or not positive on a logarithmic axis, break their curve.
// `left`: the frame keeps at least so far from the left corner [px].
void drawChart(Canvas& canvas, const Chart& chart, const Pixel& from, const Pixel& to,
               float textSize, float left = 0);

// What the numbers and the title along y need there [px].
float leftOfFrame(Canvas& canvas, const Chart& chart, float textSize);

}  // namespace render
