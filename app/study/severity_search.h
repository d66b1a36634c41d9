// How far a case can be pushed: bisection between levels that hold and levels that fail.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "scenes/study/stability_case.h"

namespace app {

struct SeverityTrial {
  double level = 0;
  bool holds = false;
};

struct SeverityBorder {
  std::vector<SeverityTrial> trials;  // in the order they were made
  std::optional<double> holds;        // the hardest level up to which all that was tried holds
  std::optional<double> fails;        // the easiest that fails; none: holds to the end
  std::optional<double> holdsBeyond;  // a level that holds although `fails` is easier
  bool stopped = false;               // `judge` gave no answer: the border is as known by then
};

constexpr int kMostTrials = 10;

// Looks between the stated level and `to`; where the stated level fails, between `from` and it.
// Assumes that harder levels fail once one does, and tries two levels below the border to see
// whether that is so. `judge`: does the criterion hold at this level? None: ends the search.
SeverityBorder searchSeverity(const scenes::StabilitySeverity& severity,
                              const std::function<std::optional<bool>(double level)>& judge);

}  // namespace app
