// Scripts for gnuplot. The strip above the axes' range holds what failed.
#include "app/study/study_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/base/gnuplot.h"
#include "app/study/study_frame.h"

namespace app {

namespace {

namespace fs = std::filesystem;
using scenes::StudyMethod;
using Points = std::vector<const StudyPoint*>;

// What a diagram is drawn against: the abscissa of a point.
using Abscissa = double (*)(const StudyPoint&);
double timeOf(const StudyPoint& point) { return point.cost(); }
double stepOf(const StudyPoint& point) { return point.h; }

// Point types of gnuplot, in the order of StudyMethod::Marker.
int pointType(StudyMethod::Marker marker) {
  constexpr int kTypes[] = {7, 5, 9, 11, 13, 15, 6, 4, 8, 10, 12, 14, 1, 2, 3};
  return kTypes[static_cast<int>(marker)];
}

// The least error of each step, the finest first.
Points leastPerStep(const Points& points) {
  Points sorted;
  for (const StudyPoint* point : points) {
    if (point->isOk()) sorted.push_back(point);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const StudyPoint* a, const StudyPoint* b) {
    return a->h != b->h ? a->h < b->h : a->errors.error < b->errors.error;
  });
  Points result;
  for (const StudyPoint* point : sorted) {
    if (result.empty() || result.back()->h < point->h) result.push_back(point);
  }
  return result;
}

// A block of data, and how it is drawn.
class Series {
 public:
  void add(const std::string& name, const Points& points, Abscissa x, const PlotFrame& frame,
           const std::string& style) {
    if (points.empty()) return;
    data_ += fmt::format("${} << EOD\n", name);
    for (const StudyPoint* point : points) {
      data_ += fmt::format("{:.9g} {:.9g}\n", x(*point), frame.shown(point->errors.error));
    }
    data_ += "EOD\n";
    addCurve(fmt::format("${} {}", name, style));
  }
  // Points that failed, at the height of the strip; each method on a line of its own.
  void addFailures(const std::string& name, const Points& points, Abscissa x, double y,
                   const std::string& style) {
    std::string rows;
    for (const StudyPoint* point : points) {
      if (point->isFailure()) rows += fmt::format("{:.9g} {:.9g}\n", x(*point), y);
    }
    if (rows.empty()) return;
    data_ += fmt::format("${} << EOD\n{}EOD\n", name, rows);
    addCurve(fmt::format("${} {}", name, style));
  }
  void addCurve(const std::string& curve) {
    curves_ += fmt::format("{}  {}", curves_.empty() ? "" : ", \\\n", curve);
  }
  std::string data() const { return data_; }
  std::string plot() const { return "plot \\\n" + curves_ + "\n"; }

 private:
  std::string data_, curves_;
};

std::string markerStyle(const StudyMethod& method, double size) {
  return fmt::format("pt {} ps {:g}", pointType(method.marker), size);
}

std::string lineTitle(const StudyResults& results, int method, bool withOrder) {
  std::string title = plotText(results.study.methods[static_cast<std::size_t>(method)].title);
  const std::optional<OrderFit> fit = results.order(method);
  if (withOrder && fit) title += fmt::format("  (order {:.2f})", fit->order);
  return title;
}

// One line per method through `chosen`; what else it has is drawn small, what failed in the strip.
void addMethods(const StudyResults& results, const PlotFrame& frame, Abscissa x,
                const std::function<Points(const Points&)>& choose, bool withOrder,
                Series& series) {
  const int count = static_cast<int>(results.study.methods.size());
  for (int m = 0; m < count; ++m) {
    const StudyMethod& method = results.study.methods[static_cast<std::size_t>(m)];
    Points all = results.of(m);
    std::erase_if(all, [&](const StudyPoint* point) { return !(x(*point) > 0); });
    const Points chosen = choose(all);
    Points others;
    for (const StudyPoint* point : all) {
      const bool isChosen = std::find(chosen.begin(), chosen.end(), point) != chosen.end();
      if (point->isOk() && !isChosen) others.push_back(point);
    }
    const std::string color = method.color.substr(1);
    series.add(
        fmt::format("other{}", m), others, x, frame,
        fmt::format("with points {} lc rgb '#a0{}' notitle", markerStyle(method, 0.5), color));
    series.add(fmt::format("line{}", m), chosen, x, frame,
               fmt::format("with linespoints {} lw 2 lc rgb '#{}' title \"{}\"",
                           markerStyle(method, 1.1), color, lineTitle(results, m, withOrder)));
    series.addFailures(
        fmt::format("failed{}", m), all, x, frame.stripLine(m, count),
        fmt::format("with points {} lw 1.5 lc rgb '#{}' notitle", markerStyle(method, 0.9), color));
  }
}

// Without what is in brackets: the page has it.
std::string shortLabel(const std::string& label) { return label.substr(0, label.find(" (")); }

void addPublished(const StudyResults& results, const PlotFrame& frame, bool againstTime,
                  Series& series) {
  constexpr int kTypes[] = {4, 6, 8, 10, 12, 14};
  std::vector<std::string> labels;
  for (const scenes::StudyPublished& published : results.study.published) {
    if (againstTime && !published.seconds) continue;
    auto found = std::find(labels.begin(), labels.end(), published.label);
    const bool isNew = found == labels.end();
    if (isNew) found = labels.insert(labels.end(), published.label);
    const auto type = static_cast<std::size_t>(found - labels.begin()) % std::size(kTypes);
    series.addCurve(fmt::format(
        "'+' using ({:.9g}):({:.9g}) every ::::0 with points pt {} ps 1.3 lw 1.6 lc rgb '#000000' "
        "{}",
        againstTime ? *published.seconds : published.h, frame.shown(published.error), kTypes[type],
        isNew ? fmt::format("title \"{}, published\"", plotText(shortLabel(published.label)))
              : "notitle"));
  }
}

// Slopes of first and second order, from the lower middle of the diagram to its right.
std::string slopeGuides(const PlotFrame& frame) {
  std::string text;
  const double width = std::log10(frame.highX / frame.lowX);
  const double height = std::log10(frame.topY / frame.lowY);
  const double right = -0.15 * width;  // decades from highX
  // Room for two words, and within the diagram.
  const double span = std::min(0.4 * height, std::clamp(0.07 * height, 0.27 * width, 0.8 * width));
  const double from = frame.highX * std::pow(10, right - span);
  const double to = frame.highX * std::pow(10, right), y = 1.4 * frame.lowY;
  for (const int order : {1, 2}) {
    const double end = y * std::pow(to / from, order);
    text += fmt::format(
        "set arrow from {:.9g},{:.9g} to {:.9g},{:.9g} nohead lw 1 dt (2,3) lc rgb '#808080'\n"
        "set label \"order {}\" at {:.9g},{:.9g} left offset 0.4,0 textcolor rgb '#707070' font "
        "',10'\n",
        from, y, to, end, order, to, end);
  }
  return text;
}

}  // namespace

std::string workPrecisionScript(const StudyResults& results) {
  const PlotFrame frame = makeFrame(results, timeOf, true);
  Series series;
  addMethods(
      results, frame, timeOf, [](const Points& points) { return front(points); }, false, series);
  addPublished(results, frame, true, series);
  return beginPlot(results, frame, "wall time per simulated second [s/s]") + realTimeLine(frame) +
         series.data() + endPlot(results.study.name, series.plot());
}

std::string convergenceScript(const StudyResults& results) {
  const PlotFrame frame = makeFrame(results, stepOf, false);
  Series series;
  addMethods(results, frame, stepOf, leastPerStep, true, series);
  addPublished(results, frame, false, series);
  return beginPlot(results, frame, "step h [s]") + slopeGuides(frame) + series.data() +
         endPlot(results.study.name + "_h", series.plot());
}

void drawPlots(const StudyResults& results, const fs::path& folder) {
  if (results.best() == nullptr) return;
  runGnuplot(workPrecisionScript(results), folder, results.study.name);
  if (!results.hasSteps()) return;
  runGnuplot(convergenceScript(results), folder, results.study.name + "_h");
}

}  // namespace app
