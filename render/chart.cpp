// Lays out frame, ticks, titles and legend, and draws the curves between them.
#include "render/chart.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/axis.h"
#include "render/chart_legend.h"

namespace render {
namespace {

const Color kInk(0.12f, 0.12f, 0.13f, 1), kRule(0.90f, 0.90f, 0.91f, 1);
constexpr int kMostTicksX = 6, kMostTicksY = 6;

// Lengths in lines of text.
constexpr float kTick = 0.22f, kMinorTick = 0.12f, kGap = 0.25f, kAxisWidth = 0.06f,
                kCurveWidth = 0.09f, kDash = 0.4f, kPause = 0.25f, kEdge = 0.2f;

bool isShown(const ChartAxis& axis, double value) {
  return std::isfinite(value) && (!axis.logarithmic || value > 0);
}

Scale scaleOf(const Chart& chart, const ChartAxis& axis, int coordinate, int most) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ChartCurve& curve : chart.curves) {
    for (const Eigen::Vector2d& point : curve.points) {
      if (!isShown(axis, point[coordinate])) continue;
      low = std::min(low, point[coordinate]);
      high = std::max(high, point[coordinate]);
    }
  }
  Scale scale = scaleOver(axis.low.value_or(low), axis.high.value_or(high), axis.logarithmic, most);
  if (axis.low) scale.low = *axis.low;
  if (axis.high) scale.high = *axis.high;
  scale.holdsLess = axis.holdsLess;
  return scale;
}

class Plotter {
 public:
  Plotter(Canvas& canvas, const Chart& chart, float size)
      : canvas_(canvas),
        chart_(chart),
        size_(size),
        x_(scaleOf(chart, chart.x, 0, kMostTicksX)),
        y_(scaleOf(chart, chart.y, 1, kMostTicksY)),
        ticksX_(ticksOf(x_, kMostTicksX)),
        ticksY_(ticksOf(y_, kMostTicksY)) {}

  float left() const {
    float widest = 0;
    for (const Tick& tick : ticksY_) widest = std::max(widest, width(tick.text));
    const float title = chart_.y.title.empty() ? 0.05f : 1.15f;
    return (kEdge + title) * size_ + widest + (kTick + 2 * kGap) * size_;
  }

  void draw(const Pixel& from, const Pixel& to, float leftAtLeast) {
    layOut(from, to, leftAtLeast);
    drawRules();
    for (const ChartCurve& curve : chart_.curves) drawCurve(curve);
    drawFrame();
    drawTitles(from, to);
    drawLegend(canvas_, chart_, legend_, size_);
  }

 private:
  float width(const std::string& words) const { return canvas_.widthOfMarked(words, size_); }
  float line(float share) const { return std::max(1.0f, std::round(share * size_)); }

  void layOut(const Pixel& from, const Pixel& to, float leftAtLeast) {
    const float last = ticksX_.empty() ? 0 : width(ticksX_.back().text) / 2;
    from_ = {from.x() + std::max(left(), leftAtLeast), from.y() + 0.5f * size_};
    to_ = {to.x() - std::max(last, 0.3f * size_) - kEdge * size_,
           to.y() - (2.15f + kTick + 2 * kGap) * size_};
    if (chart_.x.title.empty()) to_.y() += 1.1f * size_;
    legend_ = placeLegend(canvas_, chart_, size_, from_, to_, screenCurves());
    from_.y() += legend_.above;
    for (Pixel* corner : {&from_, &to_}) *corner = corner->array().round();
  }

  Pixel at(const Eigen::Vector2d& point) const {
    const float x = static_cast<float>(x_.shareOf(point.x()));
    const float y = static_cast<float>(y_.shareOf(point.y()));
    return {from_.x() + x * (to_.x() - from_.x()), to_.y() + y * (from_.y() - to_.y())};
  }

  // Unbroken pieces of a curve, on the page.
  std::vector<std::vector<Pixel>> piecesOf(const ChartCurve& curve) const {
    std::vector<std::vector<Pixel>> pieces(1);
    for (const Eigen::Vector2d& point : curve.points) {
      if (isShown(chart_.x, point.x()) && isShown(chart_.y, point.y())) {
        pieces.back().push_back(at(point));
      } else if (!pieces.back().empty()) {
        pieces.emplace_back();
      }
    }
    return pieces;
  }

  std::vector<std::vector<Pixel>> screenCurves() const {
    std::vector<std::vector<Pixel>> all;
    for (const ChartCurve& curve : chart_.curves) {
      for (auto& piece : piecesOf(curve)) all.push_back(std::move(piece));
    }
    return all;
  }

  void drawRules() {
    canvas_.fill(from_, to_, {1, 1, 1, 1});
    for (const Tick& tick : ticksX_) {
      const float x = std::round(at({tick.value, y_.low}).x());
      if (!tick.text.empty()) canvas_.curve({{x, from_.y()}, {x, to_.y()}}, kRule, 2);
    }
    for (const Tick& tick : ticksY_) {
      const float y = std::round(at({x_.low, tick.value}).y());
      if (!tick.text.empty()) canvas_.curve({{from_.x(), y}, {to_.x(), y}}, kRule, 2);
    }
  }

  bool isInside(const Pixel& p) const {
    const float slack = 0.5f;
    return p.x() >= from_.x() - slack && p.x() <= to_.x() + slack && p.y() >= from_.y() - slack &&
           p.y() <= to_.y() + slack;
  }

  void drawCurve(const ChartCurve& curve) {
    const float thickness = kCurveWidth * size_;
    for (const std::vector<Pixel>& piece : piecesOf(curve)) {
      if (curve.line) {
        for (const auto& part : clipToFrame(piece, from_, to_)) {
          if (curve.dashed) {
            canvas_.dashedCurve(part, curve.color, thickness, kDash * size_, kPause * size_);
          } else {
            drawLine(part, curve.color, thickness);
          }
        }
      }
      for (const Pixel& p : piece) {
        if (isInside(p)) drawMarker(canvas_, curve, p, size_);
      }
    }
  }

  // Sharp turns get round ends: a mitre would point far beyond the data.
  void drawLine(const std::vector<Pixel>& points, const Color& color, float thickness) {
    std::vector<Pixel> smooth;
    for (std::size_t i = 0; i < points.size(); ++i) {
      smooth.push_back(points[i]);
      if (i == 0 || i + 1 == points.size()) continue;
      const Pixel in = (points[i] - points[i - 1]).normalized();
      const Pixel out = (points[i + 1] - points[i]).normalized();
      if (in.dot(out) > 0.5f) continue;
      canvas_.curve(smooth, color, thickness);
      canvas_.disc(points[i], thickness / 2, color);
      smooth = {points[i]};
    }
    canvas_.curve(smooth, color, thickness);
  }

  void drawFrame() {
    const float thickness = line(kAxisWidth);
    canvas_.outline(from_, to_, kInk, thickness);
    for (const Tick& tick : ticksX_) {
      const float x = std::round(at({tick.value, y_.low}).x());
      const float length = (tick.text.empty() ? kMinorTick : kTick) * size_;
      canvas_.curve({{x, to_.y()}, {x, to_.y() + length}}, kInk, thickness);
      if (tick.text.empty()) continue;
      const Pixel base(x - width(tick.text) / 2, to_.y() + (kTick + kGap + 0.75f) * size_);
      canvas_.markedText(base.array().round(), size_, kInk, tick.text);
    }
    for (const Tick& tick : ticksY_) {
      const float y = std::round(at({x_.low, tick.value}).y());
      const float length = (tick.text.empty() ? kMinorTick : kTick) * size_;
      canvas_.curve({{from_.x() - length, y}, {from_.x(), y}}, kInk, thickness);
      if (tick.text.empty()) continue;
      const Pixel base(from_.x() - (kTick + kGap) * size_ - width(tick.text), y + 0.31f * size_);
      canvas_.markedText(base.array().round(), size_, kInk, tick.text);
    }
  }

  void drawTitles(const Pixel& from, const Pixel& to) {
    const float middle = (from_.x() + to_.x()) / 2 - width(chart_.x.title) / 2;
    canvas_.markedText({std::round(middle), std::round(to.y() - 0.3f * size_)}, size_, kInk,
                       chart_.x.title);
    const float centred = (from_.y() + to_.y()) / 2 + width(chart_.y.title) / 2;
    const float up = std::max(std::min(centred, to.y()), from.y() + width(chart_.y.title));
    canvas_.markedTextUpward({from.x() + (kEdge + 0.8f) * size_, up}, size_, kInk, chart_.y.title);
  }

  Canvas& canvas_;
  const Chart& chart_;
  const float size_;
  const Scale x_, y_;
  const std::vector<Tick> ticksX_, ticksY_;
  Pixel from_ = Pixel::Zero(), to_ = Pixel::Zero();  // corners of the frame
  LegendPlace legend_;
};

}  // namespace

void drawChart(Canvas& canvas, const Chart& chart, const Pixel& from, const Pixel& to,
               float textSize, float left) {
  Plotter(canvas, chart, textSize).draw(from, to, left);
}

float leftOfFrame(Canvas& canvas, const Chart& chart, float textSize) {
  return Plotter(canvas, chart, textSize).left();
}

}  // namespace render
