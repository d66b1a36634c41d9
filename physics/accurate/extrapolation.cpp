// Extrapolation, and the choice of its step and order.
#include "physics/accurate/extrapolation.h"

#include <algorithm>
#include <limits>

#include "physics/accurate/lane_rows.h"
#include "physics/model/factors.h"

namespace physics {
namespace {

// Joints are closed to this part of what a step may err by, for each of its parts; a loop's to the
// square of it, by the root of which bodies are off where rows depend on each other.
constexpr double kClosed = 1e-3;
constexpr double kLeastPart = 1.0 / (1 << 14);  // of the time asked for, in one step

}  // namespace

Extrapolation::Extrapolation(SymmetricStep step)
    : step_(std::move(step)),
      choice_(2, 2, Tableau::kMostRows,
              step_.isTree() ? StepChoice::Rows::kSideBySide : StepChoice::Rows::kInTurn) {}

// n steps from where it stands, to row_.
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
  return true;
}

// The tableau of a step, of rows of `first` steps and more. False: some row of it fails.
bool Extrapolation::fill(int first, int columns, double from, double whole,
                         const Surroundings& world, const TrialPoses& trial) {
  error_ = coarser_ = std::numeric_limits<double>::infinity();
  tableau_.clear(step_.bodies().size());
  const bool isTree = step_.isTree();
  if (isTree && !step_.stepSideBySide(first, columns, whole, world, trial)) return false;
  for (int row = 0; row < columns; ++row) {
    const int n = isTree ? first + row : stepsOfRow_ * (row + 1);
    if (isTree) {
      step_.tree().end(row, row_);
    } else if (!run(n, from, whole, world, trial)) {
      return false;
    }
    tableau_.add(n, 2, row_.pose, row_.velocity);
    if (row == 0 || row + 2 < columns) continue;
    coarser_ = error_;
    error_ = tableau_.difference(step_.size(), std::max(whole, lasting_), step_.levers());
    error_ = std::max(error_, step_.jump() / step_.size());  // all rows may agree on one
  }
  return true;
}

// Goes to T_kk. False: its joints do not close.
bool Extrapolation::takeBest(const Surroundings& world, const TrialPoses& trial) {
  tableau_.best(state_.pose, state_.velocity);
  if (step_.isTree()) {
    step_.goOnFrom(state_, trial);
  } else {
    step_.takeSpins(state_);
    if (!step_.project(state_, tolerance_, world, trial)) return false;
  }
  state_ = step_.state();
  return true;
}

bool Extrapolation::advance(IslandState& state, double time, double accuracy,
                            const Surroundings& world, const TrialPoses& trial,
                            AccuracyReport& report) {
  if (step_.isLimited(world.kinds)) return choice_.forget(), false;
  const double inAll = kShareOfFrame * accuracy;
  state_ = state;
  step_.set(state_, world, trial);
  const bool damps = step_.dampsWithin(time, world, trial);
  stepsOfRow_ = damps ? 2 : 1;
  const double way = std::max(step_.speed() * time, kShareOfFrame * step_.size());
  lasting_ = damps ? 0 : time * std::max(step_.size() / way, 1.0);
  for (double left = time; left > 0;) {
    const double from = world.time + (time - left), least = kLeastPart * time;
    const int columns = choice_.columns();
    const bool isTree = step_.isTree();
    const RowChoice rows = isTree ? cheapestRows(columns, choice_.wanted(time), left, inAll / time)
                                  : RowChoice{.step = choice_.next(left, time)};
    if (rows.step < least) return choice_.forget(), false;
    // A step ends where a table has a point: no order counts across one.
    const double whole = nextPart(world.kinds, from, rows.step, least);
    // Where joints close no further than numbers are, speeds of a step are off by it over the step.
    const double finest = step_.finest() / step_.size();
    const StepChoice::Allowance allowed{inAll * (whole / time), 1,
                                        isTree ? rows.noise : finest * lasting_ * columns / whole,
                                        isTree ? 0 : 1};
    const double known = kClosed * allowed.most();
    const double closed = step_.isLoop() ? known * known : known / (columns * columns);
    tolerance_ = step_.size() * std::max(finest, closed);
    const bool isDone = fill(rows.first, columns, from, whole, world, trial);
    const double step = whole / rows.reach;
    if (!isDone || !(error_ <= allowed.most())) {
      ++report.rejected;
      choice_.reject(step, isDone ? error_ : std::numeric_limits<double>::infinity(), allowed);
      continue;
    }
    if (!takeBest(world, trial)) return choice_.forget(), false;
    ++report.accepted;
    report.order = std::max(report.order, 2 * columns);
    report.least = report.least > 0 ? std::min(report.least, whole) : whole;
    report.estimate += error_;
    left = whole == left ? 0 : left - whole;
    choice_.accept(step, error_, coarser_, allowed, time);
  }
  state = state_;
  return true;
}

bool Extrapolation::advanceBy(IslandState& state, double time, int columns, int steps,
                              const Surroundings& world, const TrialPoses& trial) {
  state_ = state;
  step_.set(state_, world, trial);
  tolerance_ = step_.finest();
  const double h = time / steps;
  for (int s = 0; s < steps; ++s) {
    if (!fill(1, columns, world.time + s * h, h, world, trial)) return false;
    takeBest(world, trial);
  }
  state = state_;
  return true;
}

}  // namespace physics
