// The diagrams of a case: error against time, and error against the step. The strip above the
// axes' range holds what failed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/study/accuracy.h"
#include "app/base/numbers.h"

namespace app {

namespace {

using Points = std::vector<const Trace*>;
using Abscissa = double (*)(const Trace&);  // what a diagram is drawn against

double timeOf(const Trace& point) { return point.cost(); }
double stepOf(const Trace& point) { return point.h; }

std::string errorTitle(const scenes::StudyCase& study) {
  constexpr const char* kTitles[] = {"largest error", "root mean square error", "mean square error",
                                     "mean error", "error at the end"};
  const std::string title = kTitles[static_cast<int>(study.error)];
  return study.unit.empty() ? title : fmt::format("{} [{}]", title, study.unit);
}

// The least error of each step, the finest first.
Points leastPerStep(const Points& points) {
  Points sorted;
  for (const Trace* point : points) {
    if (point->isOk()) sorted.push_back(point);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const Trace* a, const Trace* b) {
    return a->h != b->h ? a->h < b->h : a->errors.error < b->errors.error;
  });
  Points result;
  for (const Trace* point : sorted) {
    if (result.empty() || result.back()->h < point->h) result.push_back(point);
  }
  return result;
}

// A diagram while it is filled.
struct CaseChart {
  const CaseResults& results;
  Abscissa x;
  bool againstTime;
  Chart chart;
  double stripFrom = 0;  // the upper end of errors that are ok

  // Holds every point; against time 1 s per s as well.
  void frame(const std::string& xTitle) {
    std::vector<double> xs, ys;
    bool hasFailure = false;
    for (const Trace& point : results.points) {
      if (!(x(point) > 0)) continue;  // it has no place in this diagram
      if (point.isOk() || point.isFailure()) xs.push_back(x(point));
      if (point.isOk()) ys.push_back(point.errors.error);
      hasFailure = hasFailure || point.isFailure();
    }
    for (const scenes::StudyPublished& published : results.study.published) {
      if (againstTime && !published.seconds) continue;
      xs.push_back(againstTime ? *published.seconds : published.h);
      ys.push_back(published.error);
    }
    if (xs.empty()) xs.push_back(1);
    if (*std::max_element(ys.begin(), ys.end()) <= 0) ys.push_back(results.study.scale);
    chart.x = logAxis(xTitle, xs);
    chart.x.low = *std::min_element(xs.begin(), xs.end()) / 1.6;
    chart.x.high = std::max(*std::max_element(xs.begin(), xs.end()) * 1.6, againstTime ? 2.0 : 0.0);
    chart.y = logAxis(errorTitle(results.study), ys);
    stripFrom = chart.y.high;
    if (hasFailure) addStrip();
    for (const double percent : {100.0, 1.0, 0.1, 0.01}) {
      const double y = percent / 100 * results.study.scale;
      if (y < chart.y.low || y > stripFrom) continue;
      chart.y.second.emplace_back(y, fmt::format("{:g} %", percent));
    }
  }

  void addStrip() {
    constexpr double kHeight = 0.09;  // of the diagram
    chart.y.high *= std::pow(10, kHeight * std::log10(chart.y.high / chart.y.low));
    chart.boxes.push_back(
        {{chart.x.low, stripFrom}, {chart.x.high, chart.y.high}, "#f3e6e3", true});
    chart.labels.push_back({{chart.x.low * std::pow(chart.x.high / chart.x.low, 0.008),
                             std::sqrt(stripFrom * chart.y.high)},
                            "failed",
                            'l',
                            10,
                            "#8a2f23"});
  }

  ChartPoint place(const Trace& point) const {
    const double error = point.errors.error;  // none at all is drawn at the bottom
    return {x(point), error >= chart.y.low ? error : 1.3 * chart.y.low};
  }

  void add(const Points& points, const scenes::StudyMethod& method, const std::string& color,
           double size, bool line, const std::string& title) {
    ChartSeries series{title, {}, color, static_cast<int>(method.marker), size, line};
    for (const Trace* point : points) series.points.push_back(place(*point));
    if (!points.empty()) chart.series.push_back(std::move(series));
  }

  // Each method's on a line of its own.
  void addFailures(const Points& points, int m, int count) {
    const scenes::StudyMethod& method = results.study.methods[static_cast<std::size_t>(m)];
    ChartSeries series{"", {}, method.color, static_cast<int>(method.marker), 0.9, false, 1.5};
    const double y = chart.y.high * std::pow(stripFrom / chart.y.high, (m + 1.0) / (count + 1.0));
    for (const Trace* point : points) {
      if (point->isFailure()) series.points.push_back({x(*point), y});
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }

  // One line per method; what else it has is drawn small, what failed in the strip.
  void addMethods() {
    const int count = static_cast<int>(results.study.methods.size());
    for (int m = 0; m < count; ++m) {
      const scenes::StudyMethod& method = results.study.methods[static_cast<std::size_t>(m)];
      Points all = results.of(m);
      std::erase_if(all, [&](const Trace* point) { return !(x(*point) > 0); });
      const Points chosen = againstTime ? front(all) : leastPerStep(all);
      Points others;
      for (const Trace* point : all) {
        const bool isChosen = std::find(chosen.begin(), chosen.end(), point) != chosen.end();
        if (point->isOk() && !isChosen) others.push_back(point);
      }
      std::string title = method.title;
      const std::optional<OrderFit> fit = againstTime ? std::nullopt : results.order(m);
      if (fit) title += fmt::format("  (order {:.2f})", fit->order);
      add(others, method, "#a0" + method.color.substr(1), 0.5, false, "");
      add(chosen, method, method.color, 1.1, true, title);
      addFailures(all, m, count);
    }
  }

  void addPublished() {
    constexpr int kOpen = 6;  // the first of the open markers
    std::vector<std::string> labels;
    for (const scenes::StudyPublished& published : results.study.published) {
      if (againstTime && !published.seconds) continue;
      // Without what is in brackets: the page has it.
      const std::string label = published.label.substr(0, published.label.find(" ("));
      const auto found = std::find(labels.begin(), labels.end(), label);
      const auto k = static_cast<int>(found - labels.begin());
      const bool isNew = found == labels.end();
      if (isNew) labels.push_back(label);
      chart.series.push_back({isNew ? label + ", published" : "",
                              {{againstTime ? *published.seconds : published.h,
                                std::max(published.error, 1.3 * chart.y.low)}},
                              "#000000",
                              kOpen + k % kOpen,
                              1.3});
    }
  }

  // Slopes of first and second order, from the lower middle of the diagram to its right.
  void addSlopes() {
    const double width = std::log10(chart.x.high / chart.x.low);
    const double height = std::log10(chart.y.high / chart.y.low);
    const double right = -0.15 * width;  // decades from the end
    // Room for two words, and within the diagram.
    const double span =
        std::min(0.4 * height, std::clamp(0.07 * height, 0.27 * width, 0.8 * width));
    const double from = chart.x.high * std::pow(10, right - span);
    const double to = chart.x.high * std::pow(10, right), y = 1.4 * chart.y.low;
    for (const int order : {1, 2}) {
      const double end = y * std::pow(to / from, order);
      chart.lines.push_back({{from, y}, {to, end}, "#808080", "(2,3)", 1, false, true});
      chart.labels.push_back(
          {{1.05 * to, end}, fmt::format("order {}", order), 'l', 10, "#707070"});
    }
  }
};

CaseChart chartOf(const CaseResults& results, Abscissa x, bool againstTime) {
  CaseChart chart{results, x, againstTime, {}};
  chart.chart.name = results.study.name + (againstTime ? "" : "_h");
  chart.chart.title = results.study.title;
  chart.chart.right = 0.55;
  chart.chart.alt = againstTime ? "error against time" : "error against the step";
  chart.frame(againstTime ? "wall time per simulated second [s/s]" : "step h [s]");
  return chart;
}

}  // namespace

Chart timeChart(const CaseResults& results) {
  CaseChart chart = chartOf(results, timeOf, true);
  const ChartAxis& y = chart.chart.y;
  chart.chart.lines.push_back({{1, y.low}, {1, y.high}, "#505050", "(8,4)", 1.4, false, true});
  chart.chart.labels.push_back({{1, y.low * std::pow(y.high / y.low, 0.02)},
                                "real time: 1/60 s for a frame",
                                'l',
                                10,
                                "#505050",
                                false,
                                true});
  chart.addMethods();
  chart.addPublished();
  return chart.chart;
}

std::optional<Chart> stepChart(const CaseResults& results) {
  if (!results.hasSteps()) return std::nullopt;
  CaseChart chart = chartOf(results, stepOf, false);
  chart.addSlopes();
  chart.addMethods();
  chart.addPublished();
  return chart.chart;
}

}  // namespace app
