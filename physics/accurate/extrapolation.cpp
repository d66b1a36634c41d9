// Extrapolation, and the choice of its step and order.
#include "physics/accurate/extrapolation.h"

#include <algorithm>
#include <limits>

#include "physics/model/factors.h"

namespace physics {
namespace {

// Joints are closed to this part of what a step may err by, for each of its parts.
constexpr double kClosed = 1e-3;
constexpr double kFinest = 1e-14;               // of the size: no closer than numbers are
constexpr double kLeastPart = 1.0 / (1 << 14);  // of the time asked for, in one step

}  // namespace

Extrapolation::Extrapolation(SymmetricStep step) : step_(std::move(step)) {}

// The next T_j1.
bool Extrapolation::run(int n, double from, double whole, const Surroundings& world,
                        const TrialPoses& trial) {
  const double h = whole / n;
  step_.restart();
  for (int k = 0; k < n; ++k) {
    takeFactors(world.kinds, world.bodies, from + k * h, from + (k + 1) * h);
    if (!step_.step(h, tolerance_, world, trial)) return false;
  }
  row_ = step_.state();
  step_.takeMomenta(row_);
  tableau_.add(n, 2, row_.pose, row_.velocity);
  return true;
}

void Extrapolation::takeBest() {
  tableau_.best(state_.pose, state_.velocity);
  step_.takeSpins(state_);
}

bool Extrapolation::advance(IslandState& state, double time, double accuracy,
                            const Surroundings& world, const TrialPoses& trial,
                            AccuracyReport& report) {
  const double allowed = kShareOfStep * accuracy;
  state_ = state;
  step_.set(state_, world, trial);
  stepsOfRow_ = step_.dampsWithin(time, world, trial) ? 2 : 1;
  for (double left = time; left > 0;) {
    const double from = world.time + (time - left), least = kLeastPart * time;
    const double wanted = choice_.next(left, time);
    const int columns = choice_.columns();
    if (wanted < least) return choice_.forget(), false;
    // A step ends where a table has a point: no order counts across one.
    const double whole = nextPart(world.kinds, from, wanted, least);
    tolerance_ = step_.size() * std::max(kFinest, kClosed * allowed / (columns * columns));
    double error = std::numeric_limits<double>::infinity(), coarser = error;  // and of one less
    tableau_.clear(step_.bodies().size());
    for (int j = 1; j <= columns && run(stepsOfRow_ * j, from, whole, world, trial); ++j) {
      coarser = error;
      if (j > 1) error = tableau_.difference(step_.size(), whole, step_.levers());
    }
    const bool isDone = tableau_.rows() == columns;
    if (!isDone || !(error <= allowed)) {
      ++report.rejected;
      choice_.reject(whole, isDone ? error : std::numeric_limits<double>::infinity(), allowed);
      continue;
    }
    takeBest();
    if (!step_.project(state_, tolerance_, world, trial)) return choice_.forget(), false;
    state_ = step_.state();
    ++report.accepted;
    report.order = std::max(report.order, 2 * columns);
    report.least = report.least > 0 ? std::min(report.least, whole) : whole;
    report.estimate += error;
    left = whole == left ? 0 : left - whole;
    choice_.accept(whole, error, coarser, allowed, time);
  }
  state = state_;
  return true;
}

bool Extrapolation::advanceBy(IslandState& state, double time, int columns, int steps,
                              const Surroundings& world, const TrialPoses& trial) {
  state_ = state;
  step_.set(state_, world, trial);
  tolerance_ = kFinest * step_.size();
  const double h = time / steps;
  for (int s = 0; s < steps; ++s) {
    tableau_.clear(step_.bodies().size());
    for (int j = 1; j <= columns; ++j) {
      if (!run(j, world.time + s * h, h, world, trial)) return false;
    }
    takeBest();
    step_.project(state_, tolerance_, world, trial);
    state_ = step_.state();
  }
  state = state_;
  return true;
}

}  // namespace physics
