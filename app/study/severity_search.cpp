// Bisection on the map's axis.
#include "app/study/severity_search.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

using scenes::StabilitySeverity;

constexpr double kFineness = 0.01;  // of the axis: the border is not wanted better
constexpr int kControls = 2;        // trials kept for levels below the border

class Search {
 public:
  Search(const StabilitySeverity& severity,
         const std::function<std::optional<bool>(double level)>& judge)
      : severity_(severity), judge_(judge) {}

  SeverityBorder run() {
    if (bracket()) {
      bisect();
      control();
    }
    conclude();
    return std::move(border_);
  }

 private:
  // False: stopped, or nothing to search.
  bool bracket() {
    const std::optional<bool> stated = tryLevel(severity_.stated);
    if (!stated) return false;
    const double other = *stated ? severity_.to : severity_.from;
    if (other == severity_.stated) return false;
    return tryLevel(other).has_value();
  }

  void bisect() {
    while (!border_.stopped && trialCount() < kMostTrials - kControls) {
      conclude();
      if (!border_.holds || !border_.fails) return;
      const double low = severity_.placeOf(*border_.holds),
                   high = severity_.placeOf(*border_.fails);
      if (high - low < kFineness) return;
      const double level = severity_.levelAt(0.5 * (low + high));
      if (isTried(level)) return;
      tryLevel(level);
    }
  }

  // Between the easiest level that was tried and the border.
  void control() {
    conclude();
    if (!border_.holds) return;
    double low = severity_.placeOf(*border_.holds);
    const double high = low;
    for (const SeverityTrial& trial : border_.trials) {
      low = std::min(low, severity_.placeOf(trial.level));
    }
    for (int k = 1; k <= kControls && !border_.stopped; ++k) {
      const double level = severity_.levelAt(low + (high - low) * k / (kControls + 1));
      const double place = severity_.placeOf(level);
      if (place > low && place < high && !isTried(level)) tryLevel(level);
    }
  }

  std::optional<bool> tryLevel(double level) {
    const std::optional<bool> holds = judge_(level);
    if (holds) {
      border_.trials.push_back({level, *holds});
    } else {
      border_.stopped = true;
    }
    return holds;
  }

  // The easiest level that fails is the border, whatever holds beyond it.
  void conclude() {
    std::vector<SeverityTrial> sorted = border_.trials;
    std::sort(sorted.begin(), sorted.end(), [&](const auto& a, const auto& b) {
      return severity_.placeOf(a.level) < severity_.placeOf(b.level);
    });
    border_.holds = border_.fails = border_.holdsBeyond = std::nullopt;
    for (const SeverityTrial& trial : sorted) {
      if (!trial.holds && !border_.fails) border_.fails = trial.level;
      if (trial.holds) (border_.fails ? border_.holdsBeyond : border_.holds) = trial.level;
    }
  }

  bool isTried(double level) const {
    return std::any_of(border_.trials.begin(), border_.trials.end(),
                       [&](const SeverityTrial& trial) { return trial.level == level; });
  }
  int trialCount() const { return static_cast<int>(border_.trials.size()); }

  const StabilitySeverity& severity_;
  const std::function<std::optional<bool>(double level)>& judge_;
  SeverityBorder border_;
};

}  // namespace

SeverityBorder searchSeverity(const StabilitySeverity& severity,
                              const std::function<std::optional<bool>(double level)>& judge) {
  return Search(severity, judge).run();
}

}  // namespace app
