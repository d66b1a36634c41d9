// Lays out the panel with fixed sizes and draws its curves.
#include "render/hud.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/axis.h"

namespace render {
namespace {

// All in pixels at 720 lines.
constexpr float kHudMargin = 16, kHudPadding = 12, kWidth = 268;
constexpr float kBarStep = 32, kBarHeight = 6;
constexpr float kTitleSize = 17, kTitleStep = 26, kRowSize = 14, kRowStep = 20;
constexpr float kPlotSize = 12, kPlotTitleStep = 18, kPlotHeight = 76, kPlotStep = 108,
                kGutter = 34, kLegendStep = 15, kNameGap = 8;
constexpr float kInside = kWidth - 2 * kHudPadding;

const Color kHudInk(0.13f, 0.14f, 0.16f, 1), kQuiet(0.42f, 0.43f, 0.46f, 1);
const Color kPanel(1, 1, 1, 0.86f), kRim(0.80f, 0.81f, 0.83f, 1),
    kPlotPaper(0.985f, 0.985f, 0.99f, 1);
const Color kPlotRule(0.90f, 0.90f, 0.92f, 1);
const Color kHolds(0.20f, 0.63f, 0.38f, 1), kBeyond(0.93f, 0.80f, 0.78f, 1);

bool shown(float value, bool logarithmic) {
  return std::isfinite(value) && (!logarithmic || value > 0);
}

float heightOf(float value, const Plot& plot, const AxisRange& range) {
  const float level = plot.logarithmic ? std::log10(value) : value;
  return std::clamp((level - range.low) / (range.high - range.low), 0.0f, 1.0f);
}

// The next of 1, 2, 5, 10 ... at or above a positive value.
float niceAbove(float value) {
  const float decade = std::pow(10.0f, std::floor(std::log10(value)));
  for (const float step : {1.0f, 2.0f, 5.0f})
    if (value <= step * decade * 1.0001f) return step * decade;
  return 10 * decade;
}

class Pen {  // a canvas with an origin and a scale
 public:
  Pen(Canvas& canvas, float scale) : canvas_(canvas), scale_(scale) {}
  Pixel at(float x, float y) const { return {std::round(x * scale_), std::round(y * scale_)}; }
  float scale() const { return scale_; }
  float widthOf(const std::string& words, float size) const {
    return canvas_.widthOf(words, size * scale_) / scale_;
  }
  Canvas& canvas() const { return canvas_; }
  void left(float x, float y, float size, const Color& color, const std::string& words) const {
    canvas_.text(at(x, y), size * scale_, color, words);
  }
  void right(float x, float y, float size, const Color& color, const std::string& words) const {
    const Pixel corner = at(x, y);
    const float width = canvas_.widthOf(words, size * scale_);
    canvas_.text({corner.x() - width, corner.y()}, size * scale_, color, words);
  }

 private:
  Canvas& canvas_;
  float scale_;
};

// Curves with more points than pixels keep the lowest and the highest of each pixel column.
void drawCurve(const Pen& pen, const Plot& plot, const Plot::Curve& curve, const AxisRange& range,
               std::size_t span, const Pixel& from, const Pixel& to) {
  const float width = to.x() - from.x(), height = to.y() - from.y();
  const auto column = [&](std::size_t i) {
    return from.x() + width * static_cast<float>(i) / static_cast<float>(span - 1);
  };
  const float thickness = std::max(1.5f * pen.scale(), 1.0f);
  std::vector<Pixel> points;
  const std::size_t count = std::min(curve.values.size(), span);
  for (std::size_t i = 0; i < count;) {
    const float x = column(i);
    float low = std::numeric_limits<float>::infinity(), high = -low;
    bool broken = false;
    do {
      const float value = curve.values[i];
      broken |= !shown(value, plot.logarithmic);
      if (broken) continue;
      const float y = heightOf(value, plot, range);
      low = std::min(low, y);
      high = std::max(high, y);
    } while (++i < count && column(i) < x + 0.5f);
    if (high >= low) points.push_back({x, to.y() - high * height});
    if (high > low) points.push_back({x, to.y() - low * height});
    if (!broken) continue;
    pen.canvas().curve(points, curve.color, thickness);
    points.clear();
  }
  pen.canvas().curve(points, curve.color, thickness);
}

std::size_t spanOf(const Plot& plot) {
  std::size_t span = static_cast<std::size_t>(std::max(plot.length, 2));
  for (const Plot::Curve& curve : plot.curves) span = std::max(span, curve.values.size());
  return span;
}

// Words that fit: smaller where they are long, and cut where they are longer than that.
struct Fitted {
  std::string words;
  float size;
};

Fitted fit(const Pen& pen, std::string words, float size, float width) {
  while (size > kPlotSize && pen.widthOf(words, size) > width) size -= 1;
  const std::string end = pen.widthOf(words, size) > width ? "…" : "";
  while (!words.empty() && pen.widthOf(words + end, size) > width) {
    const auto continues = [&] { return (words.back() & 0xC0) == 0x80; };  // a letter of UTF-8
    while (words.size() > 1 && continues()) words.pop_back();
    words.pop_back();
  }
  return {words + end, size};
}

void drawTitle(const Pen& pen, const std::string& title, float x, float y) {
  const Fitted fitted = fit(pen, title, kTitleSize, kInside);
  pen.left(x, y + kTitleSize - 3, fitted.size, kHudInk, fitted.words);
}

void drawRow(const Pen& pen, const std::string& name, const std::string& value, float x, float y) {
  pen.left(x, y + kRowSize - 2, kRowSize, kQuiet, name);
  const float left = kInside - pen.widthOf(name, kRowSize) - kNameGap;
  const Fitted fitted = fit(pen, value, kRowSize, left);
  pen.right(x + kInside, y + kRowSize - 2, fitted.size, kHudInk, fitted.words);
}

std::string titleOf(const Plot& plot) {
  return plot.unit.empty() ? plot.title : fmt::format("{} [{}]", plot.title, plot.unit);
}

// The names of curves, in the order drawn: beside the title as many as fit, the rest on lines
// below.
using LegendLines = std::vector<std::vector<const Plot::Curve*>>;

LegendLines legendOf(const Pen& pen, const Plot& plot) {
  LegendLines lines(1);
  float left = kInside - pen.widthOf(titleOf(plot), kPlotSize) - kNameGap;
  for (const Plot::Curve& curve : plot.curves) {
    if (curve.name.empty()) continue;
    const float width = pen.widthOf(curve.name, kPlotSize);
    if (width > left) {
      lines.emplace_back();
      left = kInside;
    }
    lines.back().push_back(&curve);
    left -= width + kNameGap;
  }
  return lines;
}

float heightOf(const Pen& pen, const Plot& plot) {
  return kPlotStep + static_cast<float>(legendOf(pen, plot).size() - 1) * kLegendStep;
}

// Returns by how much the plot below it starts lower.
float drawPlotTitle(const Pen& pen, const Plot& plot, float x, float y) {
  pen.left(x, y, kPlotSize, kHudInk, titleOf(plot));
  const LegendLines lines = legendOf(pen, plot);
  for (std::size_t line = 0; line < lines.size(); ++line) {
    float end = x + kInside;
    for (std::size_t i = lines[line].size(); i-- > 0;) {
      const Plot::Curve& curve = *lines[line][i];
      pen.right(end, y + static_cast<float>(line) * kLegendStep, kPlotSize, curve.color,
                curve.name);
      end -= pen.widthOf(curve.name, kPlotSize) + kNameGap;
    }
  }
  return static_cast<float>(lines.size() - 1) * kLegendStep;
}

// A row, and under it a bar that changes its colour where what holds ends.
void drawBar(const Pen& pen, const Bar& bar, float x, float y) {
  const float right = x + kInside, top = y + kRowStep;
  const auto at = [&](float share) { return x + std::clamp(share, 0.0f, 1.0f) * (right - x); };
  drawRow(pen, bar.name, bar.value, x, y);
  pen.canvas().fill(pen.at(x, top), pen.at(right, top + kBarHeight), kBeyond);
  pen.canvas().fill(pen.at(x, top), pen.at(at(bar.end), top + kBarHeight), kHolds);
  pen.canvas().fill(pen.at(at(bar.now) - 1, top - 2), pen.at(at(bar.now) + 1, top + kBarHeight + 2),
                    kHudInk);
}

void drawPlot(const Pen& pen, const Plot& plot, float x, float y) {
  y += drawPlotTitle(pen, plot, x, y + kPlotSize);
  const AxisRange range = axisRangeOf(plot);
  const Pixel from = pen.at(x + kGutter, y + kPlotTitleStep);
  const Pixel to = pen.at(x + kInside, y + kPlotTitleStep + kPlotHeight);
  pen.canvas().fill(from, to, kPlotPaper);
  const int rules = plot.logarithmic ? static_cast<int>(std::lround(range.high - range.low)) : 4;
  const int stride = (rules + 5) / 6;
  for (int i = stride; i < rules; i += stride) {
    const float share = static_cast<float>(i) / static_cast<float>(rules);
    const float level = std::round(to.y() + (from.y() - to.y()) * share) + 0.5f;
    pen.canvas().curve({{from.x(), level}, {to.x(), level}}, kPlotRule, 1);
  }
  for (const Plot::Curve& curve : plot.curves)
    drawCurve(pen, plot, curve, range, spanOf(plot), from, to);
  pen.canvas().outline(from, to, kRim, std::max(1.0f, std::round(pen.scale())));
  const float gutter = x + kGutter - 4;
  pen.right(gutter, y + kPlotTitleStep + kPlotSize - 3, kPlotSize - 1, kQuiet, range.highText);
  pen.right(gutter, y + kPlotTitleStep + kPlotHeight, kPlotSize - 1, kQuiet, range.lowText);
}

}  // namespace

AxisRange axisRangeOf(const Plot& plot) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const Plot::Curve& curve : plot.curves)
    for (const float value : curve.values) {
      if (!shown(value, plot.logarithmic)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  if (plot.logarithmic) {
    if (low > high) low = high = 1;
    const int from = static_cast<int>(std::floor(std::log10(low)));
    const int to = std::max(static_cast<int>(std::ceil(std::log10(high))), from + 1);
    return {static_cast<float>(from), static_cast<float>(to), powerOfTen(from), powerOfTen(to)};
  }
  if (low > high) return {0, 1, "0", "1"};
  low = std::min(low, 0.0f);
  high = std::max(high, 0.0f);
  if (low == high) high = 1;
  high = high > 0 ? niceAbove(high) : 0;
  low = low < 0 ? -niceAbove(-low) : 0;
  return {low, high, fmt::format("{:g}", low), fmt::format("{:g}", high)};
}

void drawHud(Canvas& canvas, const Hud& hud, float scale) {
  const Pen pen(canvas, scale);
  const float rows = static_cast<float>(hud.rows.size());
  const float bars = static_cast<float>(hud.bars.size());
  float plots = 0;
  for (const Plot& plot : hud.plots) plots += heightOf(pen, plot);
  const float title = hud.title.empty() ? 0 : kTitleStep;
  const float height = 2 * kHudPadding + title + rows * kRowStep + bars * kBarStep + plots - 4;
  const Pixel from = pen.at(kHudMargin, kHudMargin),
              to = pen.at(kHudMargin + kWidth, kHudMargin + height);
  canvas.fill(from, to, kPanel, 5 * scale);
  canvas.outline(from, to, kRim, std::max(1.0f, std::round(scale)), 5 * scale);
  const float x = kHudMargin + kHudPadding;
  float y = kHudMargin + kHudPadding;
  drawTitle(pen, hud.title, x, y);
  y += title;
  for (const auto& [name, value] : hud.rows) {
    drawRow(pen, name, value, x, y);
    y += kRowStep;
  }
  for (const Bar& bar : hud.bars) {
    drawBar(pen, bar, x, y);
    y += kBarStep;
  }
  for (const Plot& plot : hud.plots) {
    drawPlot(pen, plot, x, y);
    y += heightOf(pen, plot);
  }
}

}  // namespace render
