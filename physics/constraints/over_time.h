// A factor that follows a table over time: points joined by lines, constant outside of them.
#pragma once

#include <array>
#include <memory>
#include <vector>

namespace physics {

struct OverTime {
  static constexpr const char* kTypeWord = "[[time, factor], ...] | { points | file, repeat }";
  std::vector<std::array<double, 2>> points;  // time [s], factor; two of one time: a jump
  bool repeat = false;                        // from the first point again after the last
};

// Throws std::invalid_argument: no points, not finite, times that decrease, or, where it repeats,
// that all are one.
void check(const OverTime& table);

double valueAt(const OverTime& table, double time);            // after a jump, where there is one
double meanOf(const OverTime& table, double from, double to);  // over a span that is not empty
double nextPoint(const OverTime& table, double time);          // s, later than it; infinity: none

// What a force or a speed is multiplied by.
struct Factor {
  std::shared_ptr<const OverTime> table;  // null: 1, always
  double now = 1;                         // the mean over the present substep
};

}  // namespace physics
