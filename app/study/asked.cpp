// What was asked for and what came of it: verdicts, table and diagram.
#include "app/study/asked.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/measure/metrics.h"
#include "scenes/study/study_quantity.h"

namespace app {

namespace {

using Verdict = AskedPoint::Verdict;

constexpr double kLeastShown = 1e-14;  // round-off: what is less is drawn here

const char* wordOf(Verdict verdict) {
  constexpr const char* kWords[] = {"yes", "no", "unjudged"};
  return kWords[static_cast<int>(verdict)];
}

// Of bodies: what is measured of a scene as a whole, such as the gaps of its joints, may be right
// where the motion is not.
bool measuresMotion(const scenes::StudyCase& study) {
  return std::all_of(study.quantities.begin(), study.quantities.end(), [](const auto& quantity) {
    return scenes::findVectorMetric(quantity.metric) != nullptr ||
           scenes::findMetric(quantity.metric)->scene == nullptr;
  });
}

double overByHand(const CaseResults& results, const AskedPoint& asked) {
  if (!measuresMotion(results.study)) return 0;
  const double error = std::max(asked.asked, asked.delivered);
  double least = INFINITY;
  for (const Trace* point : results.ours()) {
    const bool isByHand = point->isOk() && !(point->key.accuracy > 0);
    if (!isByHand || results.relative(point->errors.error) > error) continue;
    least = std::min(least, point->cost());
  }
  return asked.point->cost() / least;
}

AskedPoint judged(const CaseResults& results, const Trace& point) {
  AskedPoint asked{results.study.name, &point, point.key.accuracy, INFINITY};
  asked.verdict = Verdict::kBeyond;
  asked.reference = results.relative(results.reference.accuracy.value_or(0));
  if (point.isOk()) asked.delivered = results.relative(point.errors.error);
  if (asked.delivered <= kDelivered * asked.asked) {
    asked.verdict = Verdict::kDelivered;
    asked.overByHand = overByHand(results, asked);
  } else if (asked.reference > asked.asked) {
    asked.verdict = Verdict::kUnjudged;
  }
  return asked;
}

int count(const std::vector<AskedPoint>& points, Verdict verdict) {
  return static_cast<int>(std::count_if(points.begin(), points.end(),
                                        [&](const AskedPoint& p) { return p.verdict == verdict; }));
}

// From -0.3 to 0.3 decades, in the order of the cases.
std::vector<double> placesOf(const std::vector<AskedPoint>& points) {
  constexpr double kSpread = 0.6;  // decades
  std::vector<double> places;
  std::vector<std::string> names;
  for (const AskedPoint& point : points) {
    if (names.empty() || names.back() != point.study) names.push_back(point.study);
    places.push_back(static_cast<double>(names.size() - 1));
  }
  const double last = std::max(1.0, static_cast<double>(names.size()) - 1);
  for (double& place : places) place = kSpread * (place / last - 0.5);
  return places;
}

// The points of a verdict and, where it is given, of a case.
ChartSeries marks(const std::vector<AskedPoint>& points, Verdict verdict, const std::string& study,
                  double highest) {
  const std::vector<double> places = placesOf(points);
  ChartSeries series;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const AskedPoint& p = points[i];
    if (p.verdict != verdict || !(study.empty() || study == p.study)) continue;
    series.points.push_back(
        {p.asked * std::pow(10.0, places[i]), std::clamp(p.delivered, kLeastShown, highest)});
  }
  return series;
}

// ". Of those whose case measures the motion, ..."; empty: nothing was set by hand.
std::string byHandText(const std::vector<AskedPoint>& points) {
  int all = 0, dear = 0;
  std::vector<std::pair<std::string, std::vector<double>>> cases;  // of those that are dear
  for (const AskedPoint& p : points) {
    all += p.overByHand > 0 ? 1 : 0;
    if (p.overByHand <= kDear) continue;
    ++dear;
    if (cases.empty() || cases.back().first != p.study) cases.push_back({p.study, {}});
    cases.back().second.push_back(p.overByHand);
  }
  if (all == 0) return "";
  std::string text = fmt::format(
      ". Of those whose case measures the motion, settings of ours chosen by hand deliver {} as "
      "well; {} cost at most {:g} times the cheapest of those, {} more",
      all, all - dear, kDear, dear);
  for (const auto& [name, ratios] : cases) {
    const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
    text += fmt::format("{}{} ({}{:.2g})", name == cases.front().first ? ": " : ", ", name,
                        ratios.size() > 1 ? fmt::format("{:.2g} to ", *least) : "", *most);
  }
  return text;
}

void addLine(double times, const std::string& title, const std::string& dash, Chart& chart) {
  ChartSeries line{title, {}, "#404040"};
  for (const double x : {chart.x.low, chart.x.high}) line.points.push_back({x, times * x});
  line.line = true;
  line.width = 1.3;
  line.dash = dash;
  chart.series.push_back(line);
}

void addMarks(ChartSeries series, const std::string& title, const std::string& color, int marker,
              double size, Chart& chart) {
  series.title = title;
  series.color = color;
  series.marker = marker;
  series.size = size;
  if (!series.points.empty()) chart.series.push_back(std::move(series));
}

}  // namespace

std::vector<AskedPoint> askedPoints(const std::vector<const CaseResults*>& cases) {
  std::vector<AskedPoint> asked;
  for (const CaseResults* results : cases) {
    for (const Trace& point : results->points) {
      if (point.key.accuracy > 0) asked.push_back(judged(*results, point));
    }
  }
  return asked;
}

std::string askedTable(const std::vector<AskedPoint>& points) {
  std::string text = "case,asked,delivered,estimate,reference,within,status,over_by_hand\n";
  for (const AskedPoint& p : points) {
    text += fmt::format("{},{:g},{:.4g},{:.4g},{:.4g},{},{},{:.3g}\n", p.study, p.asked,
                        p.delivered, p.point->estimate, p.reference, wordOf(p.verdict),
                        statusName(p.point->status), p.overByHand);
  }
  return text;
}

Chart askedChart(const std::vector<AskedPoint>& points) {
  Chart chart{.name = "asked", .title = "Accuracy delivered, over what was asked for"};
  chart.alt = "accuracy delivered over accuracy asked for";
  chart.caption =
      "On the line: delivered as asked. Those that were asked for the same stand beside each other "
      "in the order of the cases.";
  chart.right = 0.70;
  std::vector<double> asked, errors{1.0};
  for (const AskedPoint& p : points) {
    asked.push_back(p.asked);
    errors.push_back(kDelivered * p.asked);
    errors.push_back(std::max(p.delivered, kLeastShown));  // infinite where it failed: at the top
  }
  chart.x = logAxis("accuracy asked for", asked);
  chart.x.low /= 3;
  chart.x.high *= 3;
  chart.y = logAxis("error over the case's scale", errors);
  addLine(1, "as asked", "", chart);
  addLine(kDelivered, "three times that", "(8,4)", chart);
  const double highest = chart.y.high;
  addMarks(marks(points, Verdict::kDelivered, "", highest), "within", "#60117733", 0, 0.5, chart);
  addMarks(marks(points, Verdict::kUnjudged, "", highest), "not judged", "#808080", 6, 0.7, chart);
  std::string earlier;
  int marker = 0;
  for (const AskedPoint& p : points) {
    if (p.verdict != Verdict::kBeyond || p.study == earlier) continue;
    earlier = p.study;
    addMarks(marks(points, Verdict::kBeyond, p.study, highest), "beyond: " + p.study, "#d55e00",
             ++marker, 0.8, chart);
  }
  return chart;
}

std::string askedText(const std::vector<AskedPoint>& points) {
  if (points.empty()) return "";
  const int delivered = count(points, Verdict::kDelivered);
  const int unjudged = count(points, Verdict::kUnjudged);
  const int all = static_cast<int>(points.size()) - unjudged;
  std::string text = fmt::format(
      "{} of {} points ({:.0f} %) are within {:g} times the accuracy that they were asked for",
      delivered, all, 100.0 * delivered / std::max(1, all), kDelivered);
  if (unjudged > 0) {
    text += fmt::format("; of {} more the reference is no better than what was asked", unjudged);
  }
  return text + byHandText(points);
}

}  // namespace app
