// Numbers out of series, and series into charts.
#include "scenes/figure/figure_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenes/view/palette.h"

namespace scenes {
namespace {

using Quantity = FigureMeasure::Quantity;

bool inSpan(size_t frame, int fps, const std::optional<double>& from,
            const std::optional<double>& to) {
  constexpr double kSlack = 1e-9;  // s
  const double time = static_cast<double>(frame) / fps;
  return time >= from.value_or(0) - kSlack && time <= to.value_or(time) + kSlack;
}

// Where both are zero nothing grew.
std::vector<double> ratiosToBefore(const std::vector<double>& values) {
  std::vector<double> ratios(values.size(), 0.0);
  for (size_t i = 1; i < values.size(); ++i) {
    if (values[i] != 0 || values[i - 1] != 0) ratios[i] = values[i] / values[i - 1];
  }
  return ratios;
}

// The values of a quantity's frames.
std::vector<double> valuesOf(const Quantity& of, const FigureMeasure& measure,
                             const Series& series) {
  std::vector<double> values = series.of(of.what);
  if (!measure.law.empty()) {
    const std::vector<double> along = series.along(measure.lawAlong);
    for (size_t i = 0; i < values.size(); ++i) {
      values[i] = std::abs(values[i] - valueOnLine(measure.law, along[i]));
    }
  }
  if (measure.toFrameBefore) values = ratiosToBefore(values);
  std::vector<double> chosen;
  for (size_t i = measure.toFrameBefore ? 1 : 0; i < values.size(); ++i) {
    const bool wanted =
        of.frame ? static_cast<int>(i) == *of.frame : inSpan(i, series.fps, of.from, of.to);
    if (wanted) chosen.push_back(values[i]);
  }
  return chosen;
}

double reduce(const std::vector<double>& values, FigureMeasure::Over over) {
  if (values.empty()) return std::nan("");
  for (const double value : values) {
    if (std::isnan(value)) return value;
  }
  switch (over) {
    case FigureMeasure::Over::kMax:
      return *std::max_element(values.begin(), values.end());
    case FigureMeasure::Over::kMin:
      return *std::min_element(values.begin(), values.end());
    case FigureMeasure::Over::kMean:
      return std::accumulate(values.begin(), values.end(), 0.0) /
             static_cast<double>(values.size());
    case FigureMeasure::Over::kLast:
      break;
  }
  return values.back();
}

std::string describe(const Quantity& of, const FigureMeasure& measure, const Series& series) {
  constexpr const char* kOver[] = {"last", "largest", "smallest", "mean"};
  std::string what = of.what.metric;
  if (!of.what.body.empty()) what += " of " + of.what.body;
  if (!measure.law.empty()) what = fmt::format("|{} − law({})|", what, measure.lawAlong.metric);
  std::string when = kOver[static_cast<int>(of.over)];
  if (of.frame) when = fmt::format("at frame {}", *of.frame);
  if (of.from || of.to) {
    const double end = static_cast<double>(series.frameCount() - 1) / series.fps;
    when += fmt::format(" from {:g} to {:g} s", of.from.value_or(0), of.to.value_or(end));
  }
  return what + ", " + when;
}

// What the sheet calls a run.
const std::string& nameOf(int run, const FigureSheet& sheet) {
  const FigureRun& own = sheet.runs[static_cast<size_t>(run)];
  if (!own.name.empty()) return own.name;
  for (const FigurePanel& panel : sheet.panels) {
    if (panel.run == run) return panel.name;
  }
  return own.scene.name;
}

std::string withUnit(double value, const std::string& unit) {
  const std::string number = fmt::format("{:.6g}", value);
  return unit.empty() ? number : number + " " + unit;
}

std::string axisTitle(const std::string& metric) {
  std::string title = metric;
  std::replace(title.begin(), title.end(), '_', ' ');
  const std::string unit = unitOf(metric);
  return unit.empty() ? title : fmt::format("{} [{}]", title, unit);
}

// Strong on white, told apart by readers who do not see all hues, and by their marks.
render::Color strokeColor(size_t index) {
  constexpr const char* kColors[] = {"#2a6099", "#c0561f", "#1f8a6c", "#8e4a80",
                                     "#b8860b", "#4a90c2", "#3a3a3a"};
  return *namedColor(kColors[index % std::size(kColors)]);
}

render::ChartCurve curveOf(const FigureCurve& def, size_t index, const Series& series) {
  using render::Marker;
  constexpr Marker kMarkers[] = {Marker::kCircle, Marker::kSquare, Marker::kTriangle,
                                 Marker::kDiamond};
  render::ChartCurve curve;
  curve.name = def.name;
  curve.color = def.color.value_or(strokeColor(index));
  curve.dashed = def.dashed;
  curve.line = def.line;
  if (def.marks) curve.marker = kMarkers[index % std::size(kMarkers)];
  const std::vector<double> x = series.along(def.x), &y = series.of(def.y);
  for (size_t i = 0; i < y.size(); ++i) {
    const bool counts = static_cast<int>(i) % def.every == 0;
    if (counts && inSpan(i, series.fps, def.from, def.to)) {
      curve.points.emplace_back(def.scaleX * x[i], def.scaleY * y[i]);
    }
  }
  return curve;
}

}  // namespace

double valueOnLine(const std::vector<Eigen::Vector2d>& points, double x) {
  if (x <= points.front().x()) return points.front().y();
  for (size_t i = 1; i < points.size(); ++i) {
    const Eigen::Vector2d &a = points[i - 1], &b = points[i];
    if (x > b.x()) continue;
    return b.x() > a.x() ? a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x()) : b.y();
  }
  return points.back().y();
}

FigureVerdict judge(const FigureMeasure& measure, const FigureSheet& sheet,
                    const std::vector<Series>& series) {
  const Series& own = series[static_cast<size_t>(measure.of.run)];
  FigureVerdict verdict;
  verdict.text = measure.text;
  verdict.value = reduce(valuesOf(measure.of, measure, own), measure.of.over);
  std::string unit = unitOf(measure.of.what.metric);
  verdict.measured =
      fmt::format("{}: {}", nameOf(measure.of.run, sheet), describe(measure.of, measure, own));
  if (measure.toFrameBefore) {
    verdict.measured += " / that of the frame before";
    unit.clear();
  }
  if (measure.relativeTo) {
    const Series& other = series[static_cast<size_t>(measure.relativeTo->run)];
    verdict.value /=
        reduce(valuesOf(*measure.relativeTo, measure, other), measure.relativeTo->over);
    verdict.measured += fmt::format(" / {}: {}", nameOf(measure.relativeTo->run, sheet),
                                    describe(*measure.relativeTo, measure, other));
    unit.clear();
  }
  verdict.measured += " = " + withUnit(verdict.value, unit);
  const bool low = !measure.atLeast || verdict.value >= *measure.atLeast;
  const bool high = !measure.atMost || verdict.value <= *measure.atMost;
  verdict.holds = std::isfinite(verdict.value) && low && high;
  if (measure.atLeast) verdict.bound = "≥ " + withUnit(*measure.atLeast, unit);
  if (measure.atMost) {
    verdict.bound += (measure.atLeast ? ", " : "") + ("≤ " + withUnit(*measure.atMost, unit));
  }
  return verdict;
}

render::Chart chartOf(const FigurePlot& plot, const std::vector<Series>& series) {
  render::Chart chart{plot.x, plot.y, {}};
  if (chart.x.title.empty()) chart.x.title = axisTitle(plot.curves.front().x.metric);
  if (chart.y.title.empty()) chart.y.title = axisTitle(plot.curves.front().y.metric);
  for (const FigureLine& line : plot.lines) {
    chart.curves.push_back(
        {line.name, line.points, {0.35f, 0.35f, 0.36f, 1}, true, true, render::Marker::kNone});
  }
  for (size_t i = 0; i < plot.curves.size(); ++i) {
    const FigureCurve& curve = plot.curves[i];
    chart.curves.push_back(curveOf(curve, i, series[static_cast<size_t>(curve.run)]));
  }
  // A value below the axis' own low end is drawn on it, so that an error of zero is seen, and the
  // axis says so.
  if (chart.y.logarithmic && chart.y.low) {
    for (render::ChartCurve& curve : chart.curves) {
      for (Eigen::Vector2d& point : curve.points) {
        if (!(point.y() >= 0 && point.y() < *chart.y.low)) continue;
        point.y() = *chart.y.low;
        chart.y.holdsLess = true;
      }
    }
  }
  return chart;
}

}  // namespace scenes
