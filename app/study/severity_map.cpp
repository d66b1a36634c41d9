// The stability map of a family: how far each of its cases can be pushed, laid out line by line.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/numbers.h"
#include "app/study/stability.h"

namespace app {

namespace {

using scenes::StabilitySeverity;
constexpr double kLine = 18;                   // px
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

// What fails first and where, in few words: "joint_error, ball_socket 19, frame 34".
std::string failureText(const Trace& trace) {
  if (trace.status == Trace::Status::kTooSlow) return "given up: too much work";
  if (trace.status == Trace::Status::kRefused) return "refused";
  if (!trace.failure) return statusName(trace.status);
  const TraceFailure& failure = *trace.failure;
  const std::string what = trace.status == Trace::Status::kFails
                               ? failure.what.substr(0, failure.what.find_first_of(" :"))
                               : statusName(trace.status);
  const bool isContact = failure.constraint.empty() || failure.constraint == "contact";
  const std::string& where = isContact ? failure.bodies : failure.constraint;
  return fmt::format("{}{}{}, frame {}", what, where.empty() ? "" : ", ", where, failure.frame);
}

void drawBar(const StabilitySeverity& severity, const StabilityBar& bar, double y, Chart& chart) {
  constexpr double kHalf = 0.32;  // lines
  const std::string& color = bar.way.color;
  const SeverityBorder& border = bar.border;
  chart.labels.push_back({{-0.02, y}, bar.way.title, 'r', 10, "#000000", bar.way.method.empty()});
  const double end = border.holds ? severity.placeOf(*border.holds) : 0;
  if (border.holds) {
    chart.boxes.push_back({{0, y - kHalf}, {std::max(end, 0.004), y + kHalf}, color});
  }
  if (border.fails) {
    const double place = severity.placeOf(*border.fails);
    chart.lines.push_back({{end, y}, {place, y}, color, "(2,3)"});
    chart.labels.push_back({{place, y}, "×", 'c', 14, "#b3261e"});
  } else if (end >= 1) {
    chart.lines.push_back({{1, y}, {1.02, y}, color, "", 1.5, true});
  }
  chart.labels.push_back({{1.035, y}, borderText(bar), 'l', 9});
}

// The title, the bars and the axis of a case; gives the line below.
double drawCase(const StabilityResult& result, double y, Chart& chart) {
  const StabilitySeverity& severity = *result.study.severity;
  chart.labels.push_back({{kFarLeft, y}, result.study.title, 'l', 11, "#000000"});
  const std::string unit = severity.unit.empty() ? "" : " [" + severity.unit + "]";
  const double top = y + 0.6, bottom = top + 0.1 + static_cast<double>(result.bars.size());
  for (const double tick : ticksOf(severity)) {
    const double x = severity.placeOf(tick);
    chart.lines.push_back({{x, top}, {x, bottom}, "#d4d4d4", "", 0.6, false, true});
    chart.labels.push_back({{x, bottom + 0.4}, levelText(tick), 'c', 9, "#505050"});
  }
  const double stated = severity.placeOf(severity.stated);
  y = top + 0.55;
  for (const StabilityBar& bar : result.bars) drawBar(severity, bar, y++, chart);
  chart.lines.push_back({{0, bottom}, {1, bottom}, "#808080", "", 0.8});
  chart.lines.push_back({{stated, top - 0.05}, {stated, bottom}, "#202020", "(6,4)", 1.4});
  chart.labels.push_back(
      {{0.5, bottom + 1.25},
       fmt::format("{}{}; stated: {}", severity.label, unit, levelText(severity.stated)),
       'c',
       9,
       "#505050"});
  return bottom + 2.7;
}

}  // namespace

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

std::optional<Chart> mapOf(const std::vector<const StabilityResult*>& cases,
                           const std::string& title, const std::string& name) {
  Chart chart{.name = name};
  double y = 3.4;
  for (const StabilityResult* result : cases) {
    if (!result->bars.empty()) y = drawCase(*result, y, chart);
  }
  if (chart.labels.empty()) return std::nullopt;
  chart.labels.push_back({{kFarLeft, 0.7}, title, 'l', 14, "#000000"});
  chart.labels.push_back({{kFarLeft, 1.9},
                          "Bars: the criterion holds. ×: the easiest level that failed, and what "
                          "failed first; dotted: not tried. Dashed: the stated level. Bold: the "
                          "family's settings.",
                          'l',
                          9,
                          "#505050"});
  chart.alt = "how far each case can be pushed";
  chart.caption =
      "A bar goes as far as the criterion holds; the cross is the easiest level that failed, with "
      "what failed first. Dashed: the stated level.";
  chart.bare = true;
  chart.x.shown = chart.y.shown = false;
  chart.y.high = y;
  chart.y.reversed = true;
  chart.left = kLeft;
  chart.right = kRight;
  chart.width = 1080;
  chart.height = static_cast<int>(kLine * y);
  return chart;
}

}  // namespace app
