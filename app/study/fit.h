// What the points of a study say together: the order of convergence, the cheapest way to an
// accuracy, and the points that no other beats.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "app/study/run.h"

namespace app {

struct OrderFit {
  double order = 0;
  double deviation = 0;  // standard error of the slope; 0 with two points
  int points = 0;
  double coarsest = 0, finest = 0;  // h of the range [s]
};

struct StepError {
  double h = 0, error = 0;
};

// Least squares of log error against log h over the longest range in which the error falls with h
// (local slope of at least 0.3) and lies between `floor` and `ceiling`, its five finest points at
// the most. None: fewer than three.
std::optional<OrderFit> fitOrder(std::vector<StepError> points, double floor, double ceiling);

// The ok point with the least wall time whose error is at most `error`; null: none.
const Trace* cheapest(std::span<const Trace* const> points, double error);

// Those that no other ok point beats in both time and error, the cheapest first.
std::vector<const Trace*> front(std::span<const Trace* const> points);

}  // namespace app
