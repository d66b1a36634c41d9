// Fits and fronts.
#include "app/study/fit.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

constexpr double kLeastSlope = 0.3;
constexpr std::size_t kLeastPoints = 3;
constexpr std::size_t kMostPoints = 5;  // the finest: an order is what the error tends to

double slope(const StepError& a, const StepError& b) {
  return std::log(b.error / a.error) / std::log(b.h / a.h);
}

OrderFit leastSquares(std::span<const StepError> points) {
  const auto n = static_cast<double>(points.size());
  double meanX = 0, meanY = 0;
  for (const StepError& p : points) {
    meanX += std::log(p.h) / n;
    meanY += std::log(p.error) / n;
  }
  double xx = 0, xy = 0, yy = 0;
  for (const StepError& p : points) {
    const double x = std::log(p.h) - meanX, y = std::log(p.error) - meanY;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const double order = xy / xx;
  const double rest = std::max(0.0, yy - order * xy);  // sum of squared residuals
  const double deviation = n > 2 ? std::sqrt(rest / (n - 2) / xx) : 0;
  return {order, deviation, static_cast<int>(points.size()), points.back().h, points.front().h};
}

}  // namespace

std::optional<OrderFit> fitOrder(std::vector<StepError> points, double floor, double ceiling) {
  std::sort(points.begin(), points.end(), [](const StepError& a, const StepError& b) {
    return a.h != b.h ? a.h < b.h : a.error < b.error;
  });
  const auto sameStep = [](const StepError& a, const StepError& b) { return a.h == b.h; };
  points.erase(std::unique(points.begin(), points.end(), sameStep), points.end());
  const auto counts = [&](const StepError& p) {
    return p.error > 0 && p.error >= floor && p.error <= ceiling;
  };
  std::span<const StepError> best;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool follows =
        i > begin && counts(points[i - 1]) && slope(points[i - 1], points[i]) >= kLeastSlope;
    if (!counts(points[i])) {
      begin = i + 1;
      continue;
    }
    if (!follows) begin = i;
    if (i + 1 - begin > best.size()) best = std::span(points).subspan(begin, i + 1 - begin);
  }
  if (best.size() < kLeastPoints) return std::nullopt;
  return leastSquares(best.first(std::min(best.size(), kMostPoints)));
}

const Trace* cheapest(std::span<const Trace* const> points, double error) {
  const Trace* best = nullptr;
  for (const Trace* point : points) {
    if (!point->isOk() || point->errors.error > error) continue;
    if (best == nullptr || point->cost() < best->cost()) best = point;
  }
  return best;
}

std::vector<const Trace*> front(std::span<const Trace* const> points) {
  std::vector<const Trace*> sorted;
  for (const Trace* point : points) {
    if (point->isOk()) sorted.push_back(point);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const Trace* a, const Trace* b) {
    return a->cost() != b->cost() ? a->cost() < b->cost() : a->errors.error < b->errors.error;
  });
  std::vector<const Trace*> result;
  for (const Trace* point : sorted) {
    if (result.empty() || point->errors.error < result.back()->errors.error) {
      result.push_back(point);
    }
  }
  return result;
}

}  // namespace app
