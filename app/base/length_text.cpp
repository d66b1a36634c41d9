// Lengths with the unit that fits them.
#include "app/base/length_text.h"

#include <fmt/format.h>

namespace app {

std::string lengthText(double metres) {
  const struct {
    const char* unit;
    double size;
  } units[] = {{"km", 1e3}, {"m", 1}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}};
  for (const auto& [unit, size] : units) {
    if (metres >= size) return fmt::format("{:.3g} {}", metres / size, unit);
  }
  return fmt::format("{:.3g} m", metres);
}

}  // namespace app
