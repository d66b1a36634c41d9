// Lays the map out line by line, and writes it in gnuplot's words.
#include "app/study/stability_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/study/study_frame.h"

namespace app {

namespace {

using scenes::StabilitySeverity;
constexpr double kLine = 18;                   // pixels of the SVG
constexpr int kMapWidth = 1080;                // pixels of the SVG
constexpr double kLeft = 0.25, kRight = 0.64;  // of the width: where bars begin and end
constexpr double kEdge = 0.012;                // of the width, left free
constexpr double kFarLeft = (kEdge - kLeft) / (kRight - kLeft);
constexpr int kMostTicks = 7;
constexpr double kTickSpace = 0.07;  // of the axis, between the numbers

std::vector<double> decades(double low, double high) {
  const double sign = low < 0 ? -1 : 1;
  const double a = std::log10(std::min(std::abs(low), std::abs(high)));
  const double b = std::log10(std::max(std::abs(low), std::abs(high)));
  const int stride = std::max(1, static_cast<int>(std::ceil((b - a) / kMostTicks)));
  std::vector<double> ticks;
  for (int k = static_cast<int>(std::ceil(a - 1e-9)); k <= b + 1e-9; k += stride) {
    ticks.push_back(sign * std::pow(10, k));
  }
  return ticks;
}

std::vector<double> roundSteps(double low, double high, bool whole) {
  const double rough = (high - low) / (kMostTicks - 1);
  const double unit = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * unit;
  for (const double times : {5.0, 2.0, 1.0}) {
    if (times * unit >= rough) step = times * unit;
  }
  if (whole) step = std::max(1.0, std::round(step));
  std::vector<double> ticks;
  for (auto k = std::llround(std::ceil(low / step - 1e-9)); k * step <= high + 1e-9 * step; ++k) {
    ticks.push_back(k * step);
  }
  return ticks;
}

// Whole decades, or round steps, between the ends of the range; and the ends.
std::vector<double> ticksOf(const StabilitySeverity& severity) {
  const double low = std::min(severity.from, severity.to);
  const double high = std::max(severity.from, severity.to);
  std::vector<double> ticks =
      severity.scale == StabilitySeverity::Scale::kLog
          ? decades(low, high)
          : roundSteps(low, high, severity.scale == StabilitySeverity::Scale::kInteger);
  for (const double end : {severity.from, severity.to}) {
    const auto isNear = [&](double tick) {
      return std::abs(severity.placeOf(tick) - severity.placeOf(end)) < kTickSpace;
    };
    if (std::none_of(ticks.begin(), ticks.end(), isNear)) ticks.push_back(end);
  }
  return ticks;
}

class Drawing {
 public:
  // `y` in lines from the top.
  void text(double x, double y, const std::string& text, const std::string& how) {
    body_ += fmt::format("set label \"{}\" at {:.5f},{:.3f} {}\n", text, x, y, how);
  }
  void line(double x0, double y0, double x1, double y1, const std::string& how) {
    body_ += fmt::format("set arrow from {:.5f},{:.3f} to {:.5f},{:.3f} nohead {}\n", x0, y0, x1,
                         y1, how);
  }
  void box(double x0, double y0, double x1, double y1, const std::string& how) {
    body_ += fmt::format("set object rectangle from {:.5f},{:.3f} to {:.5f},{:.3f} {}\n", x0, y0,
                         x1, y1, how);
  }
  void arrow(double x0, double y0, double x1, double y1, const std::string& how) {
    body_ += fmt::format(
        "set arrow from {:.5f},{:.3f} to {:.5f},{:.3f} head filled size screen 0.006,25 {}\n", x0,
        y0, x1, y1, how);
  }
  const std::string& body() const { return body_; }

 private:
  std::string body_;
};

void drawBar(const StabilitySeverity& severity, const StabilityBar& bar, double y, Drawing& out) {
  constexpr double kHalf = 0.32;  // lines
  const std::string color = fmt::format("rgb '{}'", bar.way.color);
  const SeverityBorder& border = bar.border;
  const std::string name = plotText(bar.way.title);
  out.text(-0.02, y, bar.way.method.empty() ? "{/:Bold " + name + "}" : name, "right font ',10'");
  const double end = border.holds ? severity.placeOf(*border.holds) : 0;
  if (border.holds) {
    out.box(0, y - kHalf, std::max(end, 0.004), y + kHalf,
            fmt::format("fs solid 0.85 noborder fc {}", color));
  }
  if (border.fails) {
    const double place = severity.placeOf(*border.fails);
    out.line(end, y, place, y, fmt::format("lw 1 dt (2,3) lc {}", color));
    out.text(place, y, "×", fmt::format("center font ',14' textcolor rgb '#b3261e'"));
  } else if (end >= 1) {
    out.arrow(1, y, 1.02, y, fmt::format("lw 1.5 lc {}", color));
  }
  out.text(1.035, y, plotText(borderText(bar)), "left font ',9' textcolor rgb '#303030'");
}

// The title, the bars and the axis of a case; gives the line below.
double drawCase(const StabilityResult& result, double y, Drawing& out) {
  const StabilitySeverity& severity = *result.study.severity;
  out.text(kFarLeft, y, plotText(result.study.title), "left font ',11'");
  const std::string unit = severity.unit.empty() ? "" : " [" + severity.unit + "]";
  const double top = y + 0.6, bottom = top + 0.1 + static_cast<double>(result.bars.size());
  for (const double tick : ticksOf(severity)) {
    const double x = severity.placeOf(tick);
    out.line(x, top, x, bottom, "lw 0.6 lc rgb '#d4d4d4' back");
    out.text(x, bottom + 0.4, levelText(tick), "center font ',9' textcolor rgb '#505050'");
  }
  const double stated = severity.placeOf(severity.stated);
  y = top + 0.55;
  for (const StabilityBar& bar : result.bars) drawBar(severity, bar, y++, out);
  out.line(0, bottom, 1, bottom, "lw 0.8 lc rgb '#808080'");
  out.line(stated, top - 0.05, stated, bottom, "lw 1.4 dt (6,4) lc rgb '#202020' front");
  out.text(
      0.5, bottom + 1.25,
      plotText(fmt::format("{}{}; stated: {}", severity.label, unit, levelText(severity.stated))),
      "center font ',9' textcolor rgb '#505050'");
  return bottom + 2.7;
}

}  // namespace

std::string levelText(double level) {
  const double size = std::abs(level);
  if (level == 0 || (size < 99999.5 && size >= 1e-3)) {
    return size >= 1000 ? fmt::format("{:.0f}", level) : fmt::format("{:.6g}", level);
  }
  const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  return fmt::format("{:.3g}e{}", level / std::pow(10, power), power);
}

std::string failureText(const StabilityRun& run) {
  if (run.status == StabilityRun::Status::kTooLong) return "given up: too much work";
  if (run.status == StabilityRun::Status::kThrew) return "refused";
  if (!run.failure) return statusName(run.status);
  const StabilityFailure& failure = *run.failure;
  const std::string what = run.status == StabilityRun::Status::kFails
                               ? failure.what.substr(0, failure.what.find_first_of(" :"))
                               : statusName(run.status);
  const std::string& where = failure.constraint.empty() || failure.constraint == "contact"
                                 ? failure.bodies
                                 : failure.constraint;
  return fmt::format("{}{}{}, frame {}", what, where.empty() ? "" : ", ", where, failure.frame);
}

std::string borderText(const StabilityBar& bar) {
  const SeverityBorder& border = bar.border;
  if (!border.fails) {
    if (!border.holds) return "not tried";
    return bar.isSpent ? "not tried beyond: too much work" : "holds to the end of the range";
  }
  std::string text = bar.firstFailure ? failureText(*bar.firstFailure) : "fails";
  text = fmt::format("at {}: {}", levelText(*border.fails), text);
  if (border.holdsBeyond) text += fmt::format(" (holds at {})", levelText(*border.holdsBeyond));
  if (bar.isSpent) text += "; cut short";
  return text;
}

std::string mapScript(const std::vector<const StabilityResult*>& cases, const std::string& title,
                      const std::string& name) {
  Drawing drawing;
  double y = 3.4;
  for (const StabilityResult* result : cases) {
    if (!result->bars.empty()) y = drawCase(*result, y, drawing);
  }
  if (drawing.body().empty()) return "";
  drawing.text(kFarLeft, 0.7, plotText(title), "left font ',14'");
  drawing.text(
      kFarLeft, 1.9,
      "Bars: the criterion holds. ×: the easiest level that failed, and what failed first; dotted: "
      "not tried. "
      "Dashed: the stated level. {/:Bold Bold}: the family's settings.",
      "left font ',9' textcolor rgb '#505050'");
  const int height = static_cast<int>(kLine * y);
  std::string text = fmt::format(
      "unset border\nunset tics\nunset key\nset lmargin at screen {}\nset rmargin at screen {}\n"
      "set tmargin at screen 1\nset bmargin at screen 0\nset xrange [0:1]\nset yrange [{:.3f}:0]\n",
      kLeft, kRight, y);
  text += drawing.body();
  return text + endPlot(name, "plot NaN notitle\n", kMapWidth, height);
}

}  // namespace app
