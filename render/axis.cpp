// Steps of 1, 2 and 5 for linear axes, of whole decades for logarithmic ones.
#include "render/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace render {
namespace {

constexpr double kSlack = 1e-9;  // of a step: ends that are ticks up to rounding

// The least of 1, 2, 5 times a power of ten that cuts the span into at most `most` steps.
double stepOver(double span, int most) {
  const double least = span / std::max(1, most);
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= least * (1 - kSlack)) return step * decade;
  }
  return 10 * decade;
}

int decimalsOf(double step) {
  return std::max(0, -static_cast<int>(std::floor(std::log10(step) + kSlack)));
}

std::string numberText(double value, double step, double largest) {
  if (value == 0) return "0";
  std::string text;
  if (largest >= 1e5 || largest < 1e-3) {
    const int exponent = static_cast<int>(std::floor(std::log10(largest) + kSlack));
    const double scale = std::pow(10.0, exponent);
    text = fmt::format("{:.{}f}·{}", std::abs(value) / scale, decimalsOf(step / scale),
                       powerOfTen(exponent));
  } else {
    text = fmt::format("{:.{}f}", std::abs(value), decimalsOf(step));
  }
  return (value < 0 ? "−" : "") + text;
}

std::vector<Tick> linearTicks(const Scale& scale, int most) {
  std::vector<Tick> ticks;
  const double step = stepOver(scale.high - scale.low, most);
  const double largest = std::max(std::abs(scale.low), std::abs(scale.high));
  const auto first = std::llround(std::ceil(scale.low / step - kSlack));
  const auto last = std::llround(std::floor(scale.high / step + kSlack));
  for (auto i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * step;
    ticks.push_back({value, numberText(value, step, largest)});
  }
  return ticks;
}

// Every n-th decade has a text, from the end that has to have one; where decades are few, 2...9
// between them are minor ticks.
std::vector<Tick> logarithmicTicks(const Scale& scale, int most) {
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::ceil(std::log10(scale.low) - kSlack));
  const int last = static_cast<int>(std::floor(std::log10(scale.high) + kSlack));
  const int stride = std::max(1, (last - first + most - 1) / std::max(1, most));
  for (int decade = first - 1; decade <= last; ++decade) {
    const double power = std::pow(10.0, decade);
    const int from = scale.holdsLess ? first : last;
    const bool labelled = decade >= first && (from - decade) % stride == 0;
    if (decade >= first) ticks.push_back({power, labelled ? powerOfTen(decade) : ""});
    for (int k = 2; stride == 1 && k < 10; ++k) {
      const double value = k * power;
      if (value > scale.low && value < scale.high) ticks.push_back({value, ""});
    }
  }
  if (scale.holdsLess && first <= std::log10(scale.low) + kSlack) {
    for (Tick& tick : ticks) {
      if (!tick.text.empty()) {
        tick.text = "≤ " + tick.text;
        break;
      }
    }
  }
  return ticks;
}

}  // namespace

double Scale::shareOf(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return std::log10(value / low) / std::log10(high / low);
}

Scale scaleOver(double low, double high, bool logarithmic, int most) {
  if (logarithmic) {
    if (!(low <= high)) return {1, 10, true};
    const double from = std::floor(std::log10(low) + kSlack);
    const double to = std::max(std::ceil(std::log10(high) - kSlack), from + 1);
    return {std::pow(10.0, from), std::pow(10.0, to), true};
  }
  if (!(low <= high)) return {0, 1, false};
  if (high - low <= kSlack * std::max(std::abs(low), std::abs(high))) {
    const double room = low == 0 ? 1 : 0.5 * std::abs(low);
    low -= room;
    high += room;
  }
  const double step = stepOver(high - low, most);
  return {step * std::floor(low / step + kSlack), step * std::ceil(high / step - kSlack), false};
}

std::vector<Tick> ticksOf(const Scale& scale, int most) {
  return scale.logarithmic ? logarithmicTicks(scale, most) : linearTicks(scale, most);
}

std::string powerOfTen(int exponent) {
  constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

}  // namespace render
