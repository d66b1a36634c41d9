// The choice of step and order.
#include "physics/accurate/step_choice.h"

#include <algorithm>
#include <cmath>

#include "physics/accurate/lane_rows.h"
#include "physics/base/archive.h"

namespace physics {
namespace {

// Of the step that would just do, and of a step from one to the next: what is usual, II.4 there.
constexpr double kSafety = 0.8, kLeastChange = 0.1, kMostChange = 4;
// A step that cannot be solved, however short it is for its accuracy, bounds those that follow by
// half of it; the bound goes up with each one that can be, and is where it was after 14 of them.
constexpr double kFailed = 0.5, kRegained = 1.05;
constexpr double kPays = 0.9;  // another order does where it takes so much of the work: as ODEX

// Of a step, so that an error that goes with it to that power is as allowed.
double changeFor(double error, double allowed, int power) {
  if (!(allowed > 0)) return kLeastChange;
  double most = 1;  // the error that allows kMostChange, the other way round
  for (int k = 0; k < power; ++k) most *= kMostChange / kSafety;
  if (error * most <= allowed) return kMostChange;
  return std::max(kSafety * rootOf(allowed / error, power), kLeastChange);
}

}  // namespace

double rootOf(double x, int n) {
  // x = m 2^e, 1 <= m < 2. log2 m is m - 1, and 2^y is 1 + y (2 + y)/3, within a tenth: four times
  // Newton's method, which doubles its digits, for 1 < n.
  int e;
  const double m = 2 * std::frexp(x, &e), log2 = (e - 1) + (m - 1);
  const double whole = std::floor(log2 / n), y = log2 / n - whole;
  double root = std::ldexp(1 + y * (2 + y) / 3, static_cast<int>(whole));
  for (int k = 0; n > 1 && k < 5; ++k) {
    double power = 1;
    for (int i = 1; i < n; ++i) power *= root;
    root -= (root - x / power) / n;
  }
  return n > 1 ? root : x;
}

// By time. Where a step starts is looked at once, which counts as ODEX's first evaluation does.
double StepChoice::workFor(double step, int columns, double time) const {
  if (rows_ == Rows::kSideBySide) return cheapestRows(columns, step, time).work;
  return (1 + 0.5 * columns * (columns + 1)) / std::min(step, time);
}

void StepChoice::archive(Archive& a) { a(columns_, wanted_, bound_, resolves_, isRough_, lost_); }

double StepChoice::next(double left, double time) const {
  const double step = wanted(time);
  return step < left ? std::min(step, 0.5 * left) : left;
}

double StepChoice::stepFor(double step, double error, int columns, const Allowance& allowed) const {
  const int order = power_ * (columns - 1) + 1;
  const double asked = changeFor(error, allowed.error, order - allowed.grows);
  return step * std::max(asked, changeFor(error, allowed.finest, order + allowed.falls));
}

void StepChoice::reject(double step, double error, const Allowance& allowed) {
  rejected_ = true;
  if (error < 1e300) {
    wanted_ = std::min(stepFor(step, error, columns_, allowed), 0.7 * step);
  } else {
    wanted_ = bound_ = kFailed * step;
  }
}

void StepChoice::accept(double step, double error, double coarser, const Allowance& allowed,
                        double time) {
  bound_ *= kRegained;
  resolves_ = true;
  isRough_ = isRough_ && step < time;
  lost_ = 0;
  const auto bounded = [&](double of) { return std::min(of, bound_); };
  const auto pays = [&](double of, int columns, double other, int others) {
    return workFor(of, columns, time) < kPays * workFor(other, others, time);
  };
  const double here = bounded(stepFor(step, error, columns_, allowed));
  const double less =
      columns_ > least_ ? bounded(stepFor(step, coarser, columns_ - 1, allowed)) : 0;
  double chosen = here;
  if (columns_ > least_ && pays(less, columns_ - 1, here, columns_)) {
    --columns_;
    chosen = less;
  } else if (columns_ < most_ && here < bounded(time)) {
    // One more may bring what the last one has, or what it costs if that is less.
    const double gain = less > 0 ? here / less : kMostChange;
    if (columns_ == least_ || pays(gain * here, columns_ + 1, here, columns_)) {
      chosen = here * std::min(gain, (columns_ + 2.0) / columns_);
      ++columns_;
    }
  }
  // One that was cut short tells little of longer ones: these were known before.
  const double before = wanted(time);
  const double known = step < before && chosen > step ? before * std::min(chosen / here, 1.0) : 0;
  const double now = std::max(step, before), next = bounded(std::max(chosen, known));
  wanted_ = rejected_ ? std::min(next, now) : next;  // what was too long is not tried again at once
  rejected_ = false;
}

}  // namespace physics
