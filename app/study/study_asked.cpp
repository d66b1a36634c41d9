// What was asked for and what came of it: verdicts, table and diagram.
#include "app/study/study_asked.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/study/study_frame.h"

namespace app {

namespace {

using Verdict = AskedPoint::Verdict;

constexpr double kLeastShown = 1e-14;  // round-off: what is less is drawn here

const char* wordOf(Verdict verdict) {
  constexpr const char* kWords[] = {"yes", "no", "unjudged"};
  return kWords[static_cast<int>(verdict)];
}

AskedPoint judged(const StudyResults& results, const StudyPoint& point) {
  const scenes::StudyCase& study = results.study;
  const bool isSquare = study.error == scenes::StudyCase::Error::kMeanSquare;
  const auto relative = [&](double error) {
    return isSquare ? std::sqrt(error / study.scale) : error / study.scale;
  };
  AskedPoint asked{study.name, &point, point.key.accuracy, INFINITY, 0, Verdict::kBeyond};
  asked.reference = relative(results.reference.accuracy.value_or(0));
  if (point.isOk()) asked.delivered = relative(point.errors.error);
  if (asked.delivered <= kDelivered * asked.asked) {
    asked.verdict = Verdict::kDelivered;
  } else if (asked.reference > asked.asked) {
    asked.verdict = Verdict::kUnjudged;
  }
  return asked;
}

int count(const std::vector<AskedPoint>& points, Verdict verdict) {
  return static_cast<int>(std::count_if(points.begin(), points.end(),
                                        [&](const AskedPoint& p) { return p.verdict == verdict; }));
}

double power(double value, bool up) {
  return std::pow(10.0, up ? std::ceil(std::log10(value)) : std::floor(std::log10(value)));
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

// The script as it grows.
struct Marks {
  const std::vector<AskedPoint>& points;
  std::vector<double> places;
  double highest = 0;
  std::string head, plot;
  int blocks = 0;

  // Those of a verdict and, where it is given, of a case.
  void add(Verdict verdict, const std::string& study, const std::string& style) {
    std::string rows;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const AskedPoint& p = points[i];
      if (p.verdict != verdict || !(study.empty() || study == p.study)) continue;
      rows += fmt::format("{:.9g} {:.9g}\n", p.asked * std::pow(10.0, places[i]),
                          std::clamp(p.delivered, kLeastShown, highest));
    }
    if (rows.empty()) return;
    head += fmt::format("$marks{} << EOD\n{}EOD\n", blocks, rows);
    plot += fmt::format(", \\\n  $marks{} with points {}", blocks++, style);
  }
};

struct Extent {
  double leastAsked = INFINITY, mostAsked = 0, lowest = INFINITY, highest = 1;
};

Extent extentOf(const std::vector<AskedPoint>& points) {
  Extent extent;
  double highest = 0;
  for (const AskedPoint& point : points) {
    extent.leastAsked = std::min(extent.leastAsked, point.asked);
    extent.mostAsked = std::max(extent.mostAsked, point.asked);
    extent.lowest = std::min({extent.lowest, point.asked, point.delivered});
    highest = std::max(highest, kDelivered * point.asked);
    if (point.point->isOk()) highest = std::max(highest, point.delivered);
  }
  extent.lowest = power(std::max(extent.lowest, kLeastShown), false);
  extent.highest = power(highest, true);
  return extent;
}

std::string beginAsked(const Extent& extent) {
  return fmt::format(
      "# Asked against delivered. Drawn by: gnuplot THIS_FILE\n"
      "set title \"Accuracy delivered, over what was asked for\" font ',13' offset 0,-0.4\n"
      "set logscale xy\nset format xy \"10^{{%T}}\"\n"
      "set xlabel \"accuracy asked for\"\n"
      "set ylabel \"error over the case's scale\" offset 1,0\n"
      "set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n"
      "set border 3 lw 1 lc rgb '#404040'\nset tics nomirror out scale 0.7,0.35\n"
      "set grid ytics lc rgb '#ececec' lw 1 lt 1\n"
      "set lmargin at screen 0.085\nset rmargin at screen 0.70\n"
      "set key at screen 0.725,screen 0.90 left top Left reverse spacing 1.25 samplen 2 maxcols 1 "
      "maxrows 30 font "
      "',10.5'\n",
      extent.leastAsked / 3, 3 * extent.mostAsked, extent.lowest, extent.highest);
}

}  // namespace

std::vector<AskedPoint> askedPoints(const std::vector<const StudyResults*>& cases) {
  std::vector<AskedPoint> asked;
  for (const StudyResults* results : cases) {
    for (const StudyPoint& point : results->points) {
      if (point.key.accuracy > 0) asked.push_back(judged(*results, point));
    }
  }
  return asked;
}

std::string askedTable(const std::vector<AskedPoint>& points) {
  std::string text = "case,asked,delivered,estimate,reference,within,status\n";
  for (const AskedPoint& p : points) {
    text +=
        fmt::format("{},{:g},{:.4g},{:.4g},{:.4g},{},{}\n", p.study, p.asked, p.delivered,
                    p.point->estimate, p.reference, wordOf(p.verdict), statusName(p.point->status));
  }
  return text;
}

std::string askedScript(const std::vector<AskedPoint>& points) {
  const Extent extent = extentOf(points);
  Marks marks{points, placesOf(points), extent.highest, beginAsked(extent), ""};
  marks.plot = fmt::format(
      "plot x with lines lw 1.4 lc rgb '#404040' title \"as asked\", \\\n  {:g}*x with lines lw "
      "1.2 "
      "dt (8,4) lc rgb '#404040' title \"three times that\"",
      kDelivered);
  marks.add(Verdict::kDelivered, "", "pt 7 ps 0.5 lc rgb '#60117733' title \"within\"");
  marks.add(Verdict::kUnjudged, "", "pt 6 ps 0.7 lc rgb '#808080' title \"not judged\"");
  std::string earlier;
  int mark = 0;
  for (const AskedPoint& p : points) {
    if (p.verdict != Verdict::kBeyond || p.study == earlier) continue;
    earlier = p.study;
    constexpr int kTypes[] = {13, 5, 9, 11, 15, 12, 4, 8, 10, 14, 2, 3};  // of gnuplot
    marks.add(Verdict::kBeyond, p.study,
              fmt::format("pt {} ps 0.8 lc rgb '#d55e00' title \"beyond: {}\"",
                          kTypes[mark++ % static_cast<int>(std::size(kTypes))], plotText(p.study)));
  }
  return marks.head + endPlot("asked", marks.plot + "\n");
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
  return text;
}

}  // namespace app
