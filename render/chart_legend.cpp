// Tries the places a legend may have against every segment of every curve.
#include "render/chart_legend.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace render {
namespace {

const Color kLegendInk(0.12f, 0.12f, 0.13f, 1), kPaper(1, 1, 1, 0.9f);
constexpr float kSample = 1.3f, kStep = 1.2f, kMargin = 0.45f, kPadding = 0.3f, kColumnGap = 0.8f;
constexpr float kMarkerRadius = 0.2f, kLegendCurveWidth = 0.09f;  // all in lines of text

bool isNamed(const ChartCurve& curve) { return !curve.name.empty(); }

// The part [t0, t1] of a segment within the rectangle; false when none is (Liang and Barsky).
bool clip(const Pixel& a, const Pixel& b, const Pixel& from, const Pixel& to, float& t0,
          float& t1) {
  t0 = 0;
  t1 = 1;
  const Pixel d = b - a;
  for (const auto& [slope, room] :
       {std::pair{-d.x(), a.x() - from.x()}, std::pair{d.x(), to.x() - a.x()},
        std::pair{-d.y(), a.y() - from.y()}, std::pair{d.y(), to.y() - a.y()}}) {
    if (slope == 0) {
      if (room < 0) return false;
    } else if (slope < 0) {
      t0 = std::max(t0, room / slope);
    } else {
      t1 = std::min(t1, room / slope);
    }
  }
  return t0 <= t1;
}

bool isFree(const std::vector<std::vector<Pixel>>& curves, const Pixel& from, const Pixel& to) {
  for (const std::vector<Pixel>& curve : curves) {
    if (curve.size() == 1 && crosses(curve[0], curve[0], from, to)) return false;
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      if (crosses(curve[i], curve[i + 1], from, to)) return false;
    }
  }
  return true;
}

float entryWidth(Canvas& canvas, const ChartCurve& curve, float size) {
  return (kSample + 0.4f) * size + canvas.widthOfMarked(curve.name, size);
}

// How many rows the entries take side by side.
int rowsOf(Canvas& canvas, const Chart& chart, float width, float size) {
  int rows = 1;
  float x = 0;
  for (const ChartCurve& curve : chart.curves) {
    if (!isNamed(curve)) continue;
    const float own = entryWidth(canvas, curve, size);
    if (x > 0 && x + own > width) {
      ++rows;
      x = 0;
    }
    x += own + kColumnGap * size;
  }
  return rows;
}

// Where the upper left corner may be, as shares of the room there is: corners, sides, then inside.
std::vector<Pixel> placesTried() {
  constexpr int kSteps = 8;
  std::vector<Pixel> places = {{1, 0}, {0, 0}, {1, 1}, {0, 1}};
  for (int i = 1; i < kSteps; ++i) {
    const float share = static_cast<float>(i) / kSteps;
    places.insert(places.end(), {{share, 0}, {1, share}, {share, 1}, {0, share}});
  }
  for (int y = 1; y < kSteps; ++y) {
    for (int x = kSteps - 1; x > 0; --x) {
      places.emplace_back(static_cast<float>(x) / kSteps, static_cast<float>(y) / kSteps);
    }
  }
  return places;
}

void drawEntry(Canvas& canvas, const ChartCurve& curve, const Pixel& at, float size) {
  const float y = std::round(at.y() - 0.32f * size);
  const Pixel start(at.x(), y), end(at.x() + kSample * size, y);
  if (curve.line && curve.dashed)
    canvas.dashedCurve({start, end}, curve.color, kLegendCurveWidth * size, 0.4f * size,
                       0.25f * size);
  else if (curve.line)
    canvas.curve({start, end}, curve.color, kLegendCurveWidth * size);
  drawMarker(canvas, curve, (start + end) / 2, size);
  canvas.markedText({std::round(end.x() + 0.4f * size), at.y()}, size, kLegendInk, curve.name);
}

}  // namespace

bool crosses(const Pixel& a, const Pixel& b, const Pixel& from, const Pixel& to) {
  float t0 = 0, t1 = 1;
  return clip(a, b, from, to, t0, t1);
}

std::vector<std::vector<Pixel>> clipToFrame(const std::vector<Pixel>& points, const Pixel& from,
                                            const Pixel& to) {
  std::vector<std::vector<Pixel>> parts;
  bool inside = false;  // where the last segment ended
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Pixel &a = points[i], &b = points[i + 1];
    float t0 = 0, t1 = 1;
    const bool meets = clip(a, b, from, to, t0, t1);
    if (meets && !inside) parts.push_back({a + t0 * (b - a)});
    if (meets) parts.back().push_back(a + t1 * (b - a));
    inside = meets && t1 == 1;
  }
  return parts;
}

LegendPlace placeLegend(Canvas& canvas, const Chart& chart, float size, const Pixel& from,
                        const Pixel& to, const std::vector<std::vector<Pixel>>& curves) {
  LegendPlace place;
  float widest = 0, count = 0;
  for (const ChartCurve& curve : chart.curves) {
    if (!isNamed(curve)) continue;
    widest = std::max(widest, entryWidth(canvas, curve, size));
    ++count;
  }
  if (count == 0) return place;
  place.size = {widest + 2 * kPadding * size, (count * kStep + 2 * kPadding - 0.1f) * size};
  const Pixel margin(kMargin * size, kMargin * size), room(0.3f * size, 0.3f * size);
  const Pixel low = from + margin, high = to - place.size - margin;
  const bool fits = low.x() <= high.x() && low.y() <= high.y();
  for (const Pixel& share : placesTried()) {
    const Pixel corner = low + share.cwiseProduct(high - low);
    if (!fits || !isFree(curves, corner - room, corner + place.size + room)) continue;
    place.from = corner.array().round();
    return place;
  }
  place.width = to.x() - from.x();
  place.above =
      (kStep * static_cast<float>(rowsOf(canvas, chart, place.width, size)) + 0.2f) * size;
  place.from = {from.x(), from.y() - 0.3f * size};
  return place;
}

void drawLegend(Canvas& canvas, const Chart& chart, const LegendPlace& place, float size) {
  if (place.size.x() == 0) return;
  if (place.above == 0) canvas.fill(place.from, place.from + place.size, kPaper, 0.15f * size);
  const Pixel start = place.from + Pixel(kPadding * size, (kPadding + 0.8f) * size);
  Pixel at = start;
  for (const ChartCurve& curve : chart.curves) {
    if (!isNamed(curve)) continue;
    const float width = entryWidth(canvas, curve, size);
    const bool full = at.x() + width > start.x() + place.width && at.x() > start.x();
    if (place.above > 0 && full) at = {start.x(), at.y() + kStep * size};
    drawEntry(canvas, curve, at.array().round(), size);
    if (place.above > 0)
      at.x() += width + kColumnGap * size;
    else
      at.y() += kStep * size;
  }
}

void drawMarker(Canvas& canvas, const ChartCurve& curve, const Pixel& at, float size) {
  if (curve.marker == Marker::kNone) return;
  const Color rim(1, 1, 1, 1);
  for (const auto& [radius, color] : {std::pair{(kMarkerRadius + 0.06f) * size, rim},
                                      std::pair{kMarkerRadius * size, curve.color}}) {
    const float r = radius;
    if (curve.marker == Marker::kCircle) {
      canvas.disc(at, r, color);
    } else if (curve.marker == Marker::kSquare) {
      canvas.fill(at - Pixel(0.88f * r, 0.88f * r), at + Pixel(0.88f * r, 0.88f * r), color);
    } else if (curve.marker == Marker::kTriangle) {
      canvas.convexArea({at + Pixel(0, -1.15f * r), at + Pixel(1.05f * r, 0.75f * r),
                         at + Pixel(-1.05f * r, 0.75f * r)},
                        color);
    } else {
      canvas.convexArea({at + Pixel(0, -1.2f * r), at + Pixel(1.2f * r, 0), at + Pixel(0, 1.2f * r),
                         at + Pixel(-1.2f * r, 0)},
                        color);
    }
  }
}

}  // namespace render
