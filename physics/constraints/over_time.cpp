// A factor that follows a table over time.
#include "physics/constraints/over_time.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/base/types.h"

namespace physics {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

double periodOf(const OverTime& table) { return table.points.back()[0] - table.points.front()[0]; }

// The line that a time is on, up to the point `end`, and the time since the first point.
struct Line {
  std::size_t end;
  double since;
};

Line lineAt(const OverTime& table, double time) {
  const double first = table.points.front()[0];
  double since = time - first;
  if (table.repeat) {
    const double period = periodOf(table);
    since = std::fmod(since, period);
    if (since < 0) since += period;
    if (!(since < period)) since = 0;  // rounded up
  }
  const auto isLater = [&](double t, const auto& point) { return t < point[0] - first; };
  const auto end = std::upper_bound(table.points.begin(), table.points.end(), since, isLater);
  return {static_cast<std::size_t>(end - table.points.begin()), since};
}

double valueOn(const OverTime& table, const Line& line, double since) {
  const auto& points = table.points;
  if (line.end == 0) return points.front()[1];
  if (line.end == points.size()) return points.back()[1];
  const auto &a = points[line.end - 1], &b = points[line.end];
  const double part = (since - (a[0] - points.front()[0])) / (b[0] - a[0]);
  return a[1] + part * (b[1] - a[1]);
}

// From `time`, how far its line goes.
double lengthOf(const OverTime& table, const Line& line) {
  if (line.end == table.points.size()) return kNever;
  return table.points[line.end][0] - table.points.front()[0] - line.since;
}

// Lines are summed exactly by their middles.
double integral(const OverTime& table, double from, double to) {
  double sum = 0;
  for (double time = from; time < to;) {
    const Line line = lineAt(table, time);
    const double length = std::min(lengthOf(table, line), to - time);
    sum += length * valueOn(table, line, line.since + 0.5 * length);
    time = std::max(time + length, std::nextafter(time, kNever));
  }
  return sum;
}

}  // namespace

void check(const OverTime& table) {
  require(!table.points.empty(), "a table over time needs at least one point");
  for (std::size_t i = 0; i < table.points.size(); ++i) {
    const auto& [time, factor] = table.points[i];
    require(std::isfinite(time) && std::isfinite(factor),
            "times and factors of a table over time must be finite");
    require(i == 0 || time >= table.points[i - 1][0],
            "times of a table over time must not decrease");
  }
  require(!table.repeat || periodOf(table) > 0,
          "a table over time that repeats must have points at two times");
}

double valueAt(const OverTime& table, double time) {
  const Line line = lineAt(table, time);
  return valueOn(table, line, line.since);
}

double meanOf(const OverTime& table, double from, double to) {
  const double first = table.points.front()[0], period = periodOf(table);
  double sum = 0, rest = from;
  if (const double whole = table.repeat ? std::floor((to - from) / period) : 0; whole > 0) {
    sum = whole * integral(table, first, first + period);
    rest = std::min(from + whole * period, to);
  }
  return (sum + integral(table, rest, to)) / (to - from);
}

double nextPoint(const OverTime& table, double time) {
  return time + lengthOf(table, lineAt(table, time));
}

}  // namespace physics
