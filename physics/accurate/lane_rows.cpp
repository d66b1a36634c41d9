// Rows of a tableau in lanes.
#include "physics/accurate/lane_rows.h"

#include <algorithm>
#include <cmath>

#include "physics/accurate/step_choice.h"
#include "physics/accurate/tree_block.h"

namespace physics {
namespace {

// Where rows share lanes they cost nearly as much as they reach further, and longer steps are cut
// short more often (measured). More than 16 do not pay: what T_kk is made of grows.
constexpr int kMostFirst = 16, kMostShared = 3;
constexpr double kEnd = 0.5;  // what the end of a row costs in the tableau, of a step: measured
constexpr double kRounding = 1e-15;  // of a row: a few times that of a number

struct Cost {
  double reach, work, noise;
};
using Costs = std::array<std::array<Cost, kMostFirst>, Tableau::kMostRows>;

// T_kk is the sum of T_j1 times the products of n_j^2 / (n_j^2 - n_i^2).
double noiseOf(int first, int columns) {
  double sum = 0;
  for (int j = 0; j < columns; ++j) {
    const double n = first + j;
    double part = 1;
    for (int i = 0; i < columns; ++i) {
      const double other = first + i;
      if (i != j) part *= n * n / (n * n - other * other);
    }
    sum += std::abs(part);
  }
  return kRounding * sum;
}

// What is told of T_kk, its difference from T_k,k-1, is (H^(k-1) / n_2 n_3 ... n_k)^2, but for a
// factor.
Costs findCosts() {
  Costs costs;
  for (int columns = 1; columns <= Tableau::kMostRows; ++columns) {
    double product = 1;
    for (int m = 1; m <= kMostFirst; ++m) {
      const double work = LaneRows(m, columns).steps + kEnd * columns;
      const double reach = columns > 1 ? rootOf(product, columns - 1) : m;
      costs[columns - 1][m - 1] = {reach, work, noiseOf(m, columns)};
      product *= static_cast<double>(m + columns) / (m + 1);
    }
  }
  return costs;
}

}  // namespace

// The longest ones first, each to the lane that has least to do.
LaneRows::LaneRows(int first, int columns) {
  std::array<int, kTreeLanes> taken{};
  for (int j = columns; j-- > 0;) {
    const auto lane = std::min_element(taken.begin(), taken.end());
    of[j] = {static_cast<int>(lane - taken.begin()), *lane};
    *lane += first + j;
  }
  steps = *std::max_element(taken.begin(), taken.end());
}

RowChoice cheapestRows(int columns, double wanted, double left, double allowed) {
  static const Costs costs = findCosts();
  const int most = columns > kTreeLanes ? kMostShared : kMostFirst;
  RowChoice best;
  for (int m = 1; m <= most; ++m) {
    const auto [reach, work, noise] = costs[columns - 1][m - 1];
    double step = reach * wanted;
    step = step < left ? std::min(step, 0.5 * left) : left;
    if (m > 1 && noise > allowed * step) break;
    if (m == 1 || work / step < best.work) best = {m, reach, step, work / step, noise};
    if (step == left) break;
  }
  return best;
}

}  // namespace physics
