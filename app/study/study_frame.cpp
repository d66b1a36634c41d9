// Ranges and what is drawn around the data.
#include "app/study/study_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace app {

namespace {

constexpr double kLeastError = 1e-17;

double powerOfTen(double value, bool up) {
  const double exponent = std::log10(value);
  return std::pow(10.0, up ? std::ceil(exponent - 1e-9) : std::floor(exponent + 1e-9));
}

// The range of positive values seen so far.
struct Range {
  double low = INFINITY, high = 0;
  void include(double value) {
    if (!(value > 0) || !std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// At least a decade, in whole decades.
void widen(const Range& range, double& low, double& high) {
  low = powerOfTen(std::max(range.low, kLeastError), false);
  high = powerOfTen(std::max(range.high, kLeastError), true);
  if (high < 10 * low) high = 10 * low;
}

// Lines at shares of the case's scale, named on the right.
std::string percentLines(const StudyResults& results, const PlotFrame& frame) {
  std::string lines, tics;
  for (const double percent : {100.0, 1.0, 0.1, 0.01}) {
    const double y = percent / 100 * results.study.scale;
    if (y < frame.lowY || y > frame.highY) continue;
    lines += fmt::format(
        "set arrow from graph 0,first {0:.9g} to graph 1,first {0:.9g} nohead back lw 1 dt (6,4) "
        "lc rgb '#b0b0b0'\n",
        y);
    tics += fmt::format("{}\"{:g} %%\" {:.9g}", tics.empty() ? "" : ", ", percent, y);
  }
  if (tics.empty()) return "";
  return lines + fmt::format(
                     "set logscale y2\nset y2range [{:.9g}:{:.9g}]\nset y2tics ({}) scale 0 "
                     "textcolor rgb '#707070' font ',10'\n",
                     frame.lowY, frame.topY, tics);
}

std::string failureStrip(const PlotFrame& frame) {
  if (!frame.hasStrip) return "";
  return fmt::format(
      "set object 1 rectangle from graph 0,first {0:.9g} to graph 1,first {1:.9g} back fillcolor "
      "rgb "
      "'#f3e6e3' fillstyle solid noborder\n"
      "set label \"failed\" at graph 0.008,first {2:.9g} left textcolor rgb '#8a2f23' font ',10'\n",
      frame.highY, frame.topY, std::sqrt(frame.highY * frame.topY));
}

std::string errorTitle(const scenes::StudyCase& study) {
  using Error = scenes::StudyCase::Error;
  std::string title = "error";
  if (study.error == Error::kMax) title = "largest error";
  if (study.error == Error::kRms) title = "root mean square error";
  if (study.error == Error::kMeanSquare) title = "mean square error";
  if (study.error == Error::kMean) title = "mean error";
  if (study.error == Error::kFinal) title = "error at the end";
  return study.unit.empty() ? title : fmt::format("{} [{}]", title, plotText(study.unit));
}

}  // namespace

double PlotFrame::shown(double error) const { return error >= lowY ? error : 1.3 * lowY; }

double PlotFrame::stripLine(int method, int count) const {
  const double share = (method + 1.0) / (count + 1.0);
  return topY * std::pow(highY / topY, share);
}

PlotFrame makeFrame(const StudyResults& results, double (*x)(const StudyPoint&), bool realTime) {
  PlotFrame frame;
  Range xs, ys;
  for (const StudyPoint& point : results.points) {
    if (!(x(point) > 0)) continue;  // it has no place in this diagram
    if (point.isOk() || point.isFailure()) xs.include(x(point));
    if (point.isOk()) ys.include(point.errors.error);
    frame.hasStrip = frame.hasStrip || point.isFailure();
  }
  for (const scenes::StudyPublished& published : results.study.published) {
    if (!realTime) xs.include(published.h);
    if (realTime && published.seconds) xs.include(*published.seconds);
    if (!realTime || published.seconds) ys.include(published.error);
  }
  if (xs.high == 0) xs.include(1);
  if (ys.high == 0) ys.include(results.study.scale);
  widen(ys, frame.lowY, frame.highY);
  frame.lowX = xs.low / 1.6;
  frame.highX = 1.6 * xs.high;
  if (realTime) frame.highX = std::max(frame.highX, 2.0);
  constexpr double kStrip = 0.09;  // of the diagram's height
  const double decades = std::log10(frame.highY / frame.lowY);
  frame.topY = frame.hasStrip ? frame.highY * std::pow(10, kStrip * decades) : frame.highY;
  return frame;
}

std::string beginPlot(const StudyResults& results, const PlotFrame& frame, const std::string& x) {
  std::string text = fmt::format(
      "# {}: {}. Drawn by: gnuplot THIS_FILE\n"
      "set title \"{}\" font ',13' offset 0,-0.4\n"
      "set logscale xy\nset format xy \"10^{{%T}}\"\n"
      "set xlabel \"{}\"\nset ylabel \"{}\" offset 1,0\n",
      results.study.name, results.study.title, plotText(results.study.title), x,
      errorTitle(results.study));
  text += fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n", frame.lowX,
                      frame.highX, frame.lowY, frame.topY);
  text +=
      "set border 3 lw 1 lc rgb '#404040'\nset tics nomirror out scale 0.7,0.35\n"
      "set grid xtics ytics lc rgb '#ececec' lw 1 lt 1\n"
      "set lmargin at screen 0.085\nset rmargin at screen 0.58\n"
      "set key at screen 0.645,screen 0.90 left top Left reverse spacing 1.25 samplen 2 font "
      "',10.5'\n";
  return text + percentLines(results, frame) + failureStrip(frame);
}

std::string realTimeLine(const PlotFrame&) {
  return "set arrow from 1,graph 0 to 1,graph 1 nohead lw 1.4 dt (8,4) lc rgb '#505050'\n"
         "set label \"real time: 1/60 s for a frame\" at 1,graph 0.02 left rotate by 90 "
         "offset -0.8,0 textcolor rgb '#505050' font ',10'\n";
}

std::string endPlot(const std::string& name, const std::string& plot, int width, int height) {
  return fmt::format(
      "set terminal svg size {2},{3} font 'DejaVu Sans,11' background rgb 'white'\n"
      "set output '{0}.svg'\n{1}unset output\n"
      "set terminal pngcairo size {4},{5} fontscale 2 linewidth 2 pointscale 2 font 'DejaVu "
      "Sans,11' "
      "background rgb 'white'\n"
      "set output '{0}.png'\nreplot\nunset output\n",
      name, plot, width, height, 2 * width, 2 * height);
}

std::string superscript(std::string text) {
  constexpr std::pair<const char*, const char*> kPowers[] = {{"^2", "²"}, {"^3", "³"}};
  for (const auto& [plain, raised] : kPowers) {
    for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain)) {
      text.replace(at, std::strlen(plain), raised);
    }
  }
  return text;
}

std::string plotText(const std::string& text) {
  std::string plain;
  for (const char c : superscript(text)) {
    if (c == '_' || c == '^' || c == '{' || c == '}' || c == '@' || c == '&' || c == '~') {
      plain += "\\\\";
    }
    if (c == '"' || c == '\\') {
      plain += '\'';
    } else {
      plain += c;
    }
  }
  return plain;
}

}  // namespace app
