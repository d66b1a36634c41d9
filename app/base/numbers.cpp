// Numbers as people read them.
#include "app/base/numbers.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <utility>

namespace app {

std::string lengthText(double metres) {
  const struct {
    const char* unit;
    double size;
  } units[] = {{"km", 1e3}, {"m", 1}, {"mm", 1e-3}, {"µm", 1e-6}, {"nm", 1e-9}, {"pm", 1e-12}};
  for (const auto& [unit, size] : units) {
    if (metres >= size) return fmt::format("{:.3g} {}", metres / size, unit);
  }
  return fmt::format("{:.3g} m", metres);
}

std::string textBeyond(double value, double limit) {
  for (int digits = 3;; ++digits) {
    std::string text = fmt::format("{:.{}g}", value, digits);
    if (digits == 17 || text != fmt::format("{:.{}g}", limit, digits)) return text;
  }
}

std::string percentText(double share) { return fmt::format("{:g} %", 100 * share); }

std::string wholePercentText(double share) {
  const double percent = std::round(100 * share);
  return fmt::format("{:.0f} %", percent == 0 ? 0 : percent);  // -0 is 0
}

std::string secondsText(double seconds) {
  if (!std::isfinite(seconds)) return "–";
  if (seconds >= 1) return fmt::format("{:.3g} s", seconds);
  if (seconds >= 1e-3) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return fmt::format("{:.3g} µs", 1e6 * seconds);
}

std::string numberText(double value) {
  if (!std::isfinite(value)) return "–";
  return fmt::format("{:.2g}", value);
}

std::string levelText(double level) {
  const double size = std::abs(level);
  if (level == 0 || (size < 99999.5 && size >= 1e-3)) {
    return size >= 1000 ? fmt::format("{:.0f}", level) : fmt::format("{:.6g}", level);
  }
  const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  return fmt::format("{:.3g}e{}", level / std::pow(10, power), power);
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

}  // namespace app
