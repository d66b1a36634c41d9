// The choice of step and order.
#include "physics/accurate/step_choice.h"

#include <algorithm>

#include "physics/base/archive.h"

namespace physics {
namespace {

constexpr double kSafety = 0.9;                        // of the step that would just do
constexpr double kLeastChange = 0.1, kMostChange = 4;  // of a step, from one to the next
constexpr double kFailed = 0.25;
constexpr double kPays = 0.9;  // another order does where it takes so much of the work

int workOf(int columns) { return columns * (columns + 1) / 2; }

}  // namespace

double rootOf(double x, int n) {
  double unit = 1, scale = 1, root = 1;
  for (int k = 0; k < n; ++k) unit *= 2;
  for (; x > unit; x /= unit) scale *= 2;
  for (; x < 1 / unit; x *= unit) scale /= 2;
  for (int k = 0; k < 40; ++k) {
    double power = 1;
    for (int i = 1; i < n; ++i) power *= root;
    const double next = root - (root - x / power) / n;
    if (next == root) break;
    root = next;
  }
  return scale * root;
}

void StepChoice::archive(Archive& a) { a(columns_, wanted_); }

double StepChoice::next(double left, double time) {
  if (!(wanted_ > 0)) wanted_ = time;
  if (wanted_ >= left) return left;
  return std::min(wanted_, 0.5 * left);
}

double StepChoice::stepFor(double step, double error, int columns, double allowed) const {
  constexpr double kNone = 1e-9;  // of what is allowed: smaller errors tell no more
  const double times = allowed / std::max(error, kNone * allowed);
  const double change = kSafety * rootOf(times, power_ * (columns - 1) + 1);
  return step * std::clamp(change, kLeastChange, kMostChange);
}

void StepChoice::reject(double step, double error, double allowed) {
  const bool isKnown = error < 1e300;
  wanted_ =
      isKnown ? std::min(stepFor(step, error, columns_, allowed), 0.7 * step) : kFailed * step;
}

void StepChoice::accept(double step, double error, double coarser, double allowed, double time) {
  const auto rate = [&](double of, int columns) { return workOf(columns) / std::min(of, time); };
  const double here = stepFor(step, error, columns_, allowed);
  const double less = columns_ > least_ ? stepFor(step, coarser, columns_ - 1, allowed) : 0;
  double next = here;
  if (columns_ > least_ && rate(less, columns_ - 1) < kPays * rate(here, columns_)) {
    --columns_;
    next = less;
  } else if (columns_ < most_ && here < time &&
             (columns_ == least_ || rate(here, columns_) < kPays * rate(less, columns_ - 1))) {
    next = here * workOf(columns_ + 1) / workOf(columns_);
    ++columns_;
  }
  const bool isTrimmed = step < wanted_ && next > step;
  wanted_ = isTrimmed ? std::max(next, wanted_) : next;
}

}  // namespace physics
