// Curves, laws and measures, each with the run it is about.
#include "scenes/figure/figure_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/read/read_body.h"
#include "scenes/read/settings_reader.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;
using Quantity = FigureMeasure::Quantity;

std::vector<Eigen::Vector2d> readPoints(TableReader& reader, const char* key) {
  std::vector<Eigen::Vector2d> points;
  const Value* value = reader.take(key);
  if (value == nullptr) return points;
  if (!value->isArray() || value->items.size() < 2) {
    failExpected(reader.spot({key}), *value, "at least two points [x, y]");
  }
  for (const Value& item : value->items) {
    const auto pair = readPair(item, reader.spot({key}));
    points.emplace_back(pair[0], pair[1]);
  }
  return points;
}

render::ChartAxis readAxis(TableReader& plot, const char* word) {
  render::ChartAxis axis;
  readTable(plot, word, [&](TableReader& reader) {
    reader(Field{"title"}, axis.title);
    reader(Field{"log"}, axis.logarithmic);
    const double least = axis.logarithmic ? kPositive : -std::numeric_limits<double>::infinity();
    reader(Field{"low", Unit::kNone, false, least}, axis.low);
    reader(Field{"high", Unit::kNone, false, least}, axis.high);
    if (axis.low && axis.high && *axis.low >= *axis.high) {
      reader.failAt("high", fmt::format("expected a number > low = {:g}", *axis.low));
    }
  });
  return axis;
}

// x = "time" | "frame" | "iteration" or a metric, then with `x_body` where it is a body's.
void readAlong(TableReader& reader, const char* key, const char* bodyKey, MetricOf& along) {
  const Value* value = reader.take(key);
  if (value == nullptr || (value->isString() && isClock(value->text))) {
    if (value != nullptr) along.metric = value->text;
    if (reader.has(bodyKey)) reader.failAt(bodyKey, fmt::format("expected none for a clock"));
    return;
  }
  readMetric(reader, along.metric, along.body, key, bodyKey);
}

void readCurve(TableReader& reader, const FigureSheet& sheet, FigurePlot& plot) {
  FigureCurve curve;
  curve.run = readRunName(reader, "panel", sheet);
  readMetric(reader, curve.y.metric, curve.y.body);
  readAlong(reader, "x", "x_body", curve.x);
  reader(Field{"scale"}, curve.scaleY);
  reader(Field{"x_scale"}, curve.scaleX);
  reader(Field{"name"}, curve.name);
  reader(Field{"dashed"}, curve.dashed);
  reader(Field{"marks"}, curve.marks);
  reader(Field{"line"}, curve.line);
  reader(Field{"every", Unit::kNone, false, 1, 1e6}, curve.every);
  reader(Field{"from", Unit::kNone, false, 0}, curve.from);
  reader(Field{"to", Unit::kNone, false, 0}, curve.to);
  readColor(reader, curve.color);
  if (!curve.line && !curve.marks) reader.failAt("line", "expected true, or marks = true as well");
  plot.curves.push_back(curve);
}

void readLine(TableReader& reader, FigurePlot& plot) {
  FigureLine line;
  reader(Field{"name"}, line.name);
  line.points = readPoints(reader, "points");
  if (line.points.empty()) reader.failHere("expected a value for 'points'");
  plot.lines.push_back(line);
}

void readSpan(TableReader& reader, const Scene& scene, Quantity& of) {
  reader(Field{"over"}, of.over);
  reader(Field{"frame", Unit::kNone, false, 0}, of.frame);
  reader(Field{"from", Unit::kNone, false, 0}, of.from);
  reader(Field{"to", Unit::kNone, false, 0}, of.to);
  for (const char* other : {"over", "from", "to"}) reader.atMostOne("frame", other);
  if (of.frame && *of.frame >= scene.frameCount()) {
    reader.failAt("frame",
                  fmt::format("expected a frame below {}, got {}", scene.frameCount(), *of.frame));
  }
  if (of.from.value_or(0) > of.to.value_or(scene.duration)) {
    reader.failAt("from", fmt::format("expected a time <= {:g} s, the end of the span",
                                      of.to.value_or(scene.duration)));
  }
}

// relative_to = "start", "before", or a panel, or { panel, metric, body, over, frame, from, to }.
void readRelative(TableReader& reader, const FigureSheet& sheet, FigureMeasure& measure) {
  const Value* value = reader.take("relative_to");
  if (value == nullptr) return;
  Quantity other = measure.of;
  if (value->isString() && value->text == "before") {
    measure.toFrameBefore = true;
    return;
  }
  if (value->isString() && value->text == "start") {
    other.frame = 0;
  } else if (value->isString()) {
    other.run = readRunName(reader, "relative_to", sheet);
  } else {
    if (!value->isTable()) {
      failExpected(reader.spot({"relative_to"}), *value,
                   "\"start\", \"before\", a panel, or a table");
    }
    TableReader table(*value, "measure.relative_to", reader.context());
    if (table.has("panel")) other.run = readRunName(table, "panel", sheet);
    if (table.has("metric")) {
      other.what.body.clear();
      readMetric(table, other.what.metric, other.what.body);
    }
    readSpan(table, sheet.runs[static_cast<size_t>(other.run)].scene, other);
    table.take("panel");
    table.finish();
  }
  measure.relativeTo = other;
}

void readLaw(TableReader& reader, FigureMeasure& measure) {
  measure.law = readPoints(reader, "law");
  measure.lawAlong.metric = "time";
  readAlong(reader, "law_along", "law_body", measure.lawAlong);
  if (!measure.law.empty() && (measure.relativeTo || measure.toFrameBefore)) {
    reader.failAt("law", "expected no 'relative_to' beside it");
  }
}

}  // namespace

std::span<const char* const> names(FigureMeasure::Over) {
  static constexpr const char* kNames[] = {"last", "max", "min", "mean"};
  return kNames;
}

std::span<const Value> itemsOf(const TableReader& reader, const char* word) {
  const Value* value = reader.table().find(word);
  return value == nullptr ? std::span<const Value>() : std::span<const Value>(value->items);
}

std::array<double, 2> readPair(const Value& value, const Spot& spot) {
  std::array<double, 2> pair{};
  if (!value.isArray() || value.items.size() != 2) failExpected(spot, value, "[x, y]");
  for (size_t i = 0; i < 2; ++i) readValue(value.items[i], spot, pair[i]);
  return pair;
}

int readRunName(TableReader& reader, const char* key, const FigureSheet& sheet) {
  std::string name;
  reader(Field{key, Unit::kNone, true}, name);
  std::vector<std::string> known;
  for (size_t i = 0; i < sheet.runs.size(); ++i) {
    if (sheet.runs[i].name == name) return static_cast<int>(i);
    if (!sheet.runs[i].name.empty()) known.push_back(sheet.runs[i].name);
  }
  for (const FigurePanel& panel : sheet.panels) {
    if (panel.name == name) return panel.run;
    known.push_back(panel.name);
  }
  reader.failAt(key, fmt::format("no panel or run '{}'{}", name, didYouMean(name, known)));
}

void readPlot(TableReader& reader, FigureSheet& sheet) {
  FigurePlot plot;
  reader(Field{"name"}, plot.name);
  reader(Field{"label"}, plot.label);
  plot.x = readAxis(reader, "x");
  plot.y = readAxis(reader, "y");
  reader(Field{"span", Unit::kNone, false, 1, 12}, plot.span);
  reader(Field{"aspect", Unit::kNone, false, 0.2, 8}, plot.aspect);
  readTables(reader, "curve", [&](TableReader& curve) { readCurve(curve, sheet, plot); });
  readTables(reader, "line", [&](TableReader& line) { readLine(line, plot); });
  if (plot.curves.empty()) reader.failHere("expected at least one [[plot.curve]]");
  sheet.plots.push_back(std::move(plot));
}

void readMeasure(TableReader& reader, FigureSheet& sheet) {
  FigureMeasure measure;
  reader(Field{"text", Unit::kNone, true}, measure.text);
  measure.of.run = readRunName(reader, "panel", sheet);
  readMetric(reader, measure.of.what.metric, measure.of.what.body);
  readSpan(reader, sheet.runs[static_cast<size_t>(measure.of.run)].scene, measure.of);
  readRelative(reader, sheet, measure);
  readLaw(reader, measure);
  reader(Field{"at_most"}, measure.atMost);
  reader(Field{"at_least"}, measure.atLeast);
  if (!measure.atMost && !measure.atLeast) {
    reader.failHere("expected 'at_most' or 'at_least'");
  }
  sheet.measures.push_back(std::move(measure));
}

std::vector<MetricOf> metricsOf(const FigureSheet& sheet, int run) {
  std::vector<MetricOf> wanted;
  const auto want = [&](int ofRun, const MetricOf& metric) {
    if (ofRun != run || metric.metric.empty() || isClock(metric.metric)) return;
    if (std::find(wanted.begin(), wanted.end(), metric) == wanted.end()) wanted.push_back(metric);
  };
  for (const FigurePlot& plot : sheet.plots) {
    for (const FigureCurve& curve : plot.curves) {
      want(curve.run, curve.x);
      want(curve.run, curve.y);
    }
  }
  for (const FigureMeasure& measure : sheet.measures) {
    want(measure.of.run, measure.of.what);
    if (!measure.law.empty()) want(measure.of.run, measure.lawAlong);
    if (measure.relativeTo) want(measure.relativeTo->run, measure.relativeTo->what);
  }
  return wanted;
}

}  // namespace scenes
