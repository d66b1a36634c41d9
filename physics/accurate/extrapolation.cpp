// Extrapolation, and the choice of its step and order.
#include "physics/accurate/extrapolation.h"

#include <algorithm>
#include <limits>

#include "physics/model/factors.h"

namespace physics {
namespace {

// Joints are closed to this part of what a step may err by, for each of its parts.
constexpr double kClosed = 1e-3;
constexpr double kFinest = 1e-14;  // of the size: no closer than numbers are
// T_11 alone may err by this part of what a step may: nothing is left out of it, and it adds up.
constexpr double kAlone = 0.25;
constexpr double kPromising = 0.5;       // of that, by the last step: else it is not tried
constexpr int kMostTrusted = 16;                // steps by what the last T_22 told
constexpr double kOfTrapezoid = 1 / 12.0;       // its error, of the third derivative times h^3
constexpr double kLeastPart = 1.0 / (1 << 14);  // of the time asked for, in one step

bool isSame(std::span<const Velocity> a, std::span<const Velocity> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Velocity& p, const Velocity& q) { return p.v == q.v && p.w == q.w; });
}

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

// How much the motion bends in a step that ends so: the third derivative of its ways times h^3, by
// what the last two steps changed velocities by, over the island's size.
double Extrapolation::bendOf(double whole, std::span<const Velocity> end) const {
  const auto levers = step_.levers();
  double most = 0;
  for (std::size_t i = 0; i < end.size(); ++i) {
    const auto bend = [&](const Vec3& first, const Vec3& second, const Vec3& third) {
      return ((third - second) / whole - (second - first) / lasted_).norm();
    };
    most = std::max(most, bend(before_[i].v, now_[i].v, end[i].v) +
                              levers[i] * bend(before_[i].w, now_[i].w, end[i].w));
  }
  return 2 * whole * whole * whole / (whole + lasted_) * most / step_.size();
}

// A step that ended, by T_kk, and what T_11 erred by.
void Extrapolation::note(double whole, double error) {
  bent_ = lasted_ > 0 ? bendOf(whole, state_.velocity) : 0;
  errs_ = bent_ > 0 ? std::max(error / bent_, kOfTrapezoid) : 0;
  trusted_ = 0;
  std::swap(before_, now_);
  now_ = state_.velocity;
  lasted_ = whole;
}

// T_11, where that is enough; else the step is to be made anew.
bool Extrapolation::runAlone(double from, double whole, double allowed, const Surroundings& world,
                             const TrialPoses& trial, double& error) {
  if (!(errs_ > 0) || trusted_ >= kMostTrusted || whole > 1.01 * lasted_) return false;
  if (!(errs_ * bent_ <= kPromising * kAlone * allowed)) return false;
  const double h = whole / stepsOfRow_;
  for (int k = 0; k < stepsOfRow_; ++k) {
    takeFactors(world.kinds, world.bodies, from + k * h, from + (k + 1) * h);
    if (!step_.step(h, tolerance_, world, trial)) return false;
  }
  bent_ = bendOf(whole, step_.state().velocity);
  error = errs_ * bent_;
  if (!(error <= kAlone * allowed)) return errs_ = 0, false;
  step_.stay();
  ++trusted_;
  state_ = step_.state();
  std::swap(before_, now_);
  now_ = state_.velocity;
  lasted_ = whole;
  return true;
}

void Extrapolation::archive(Archive& a) {
  a(step_, choice_, before_, now_, lasted_, errs_, bent_, trusted_);
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
  if (!isSame(now_, state.velocity)) {  // it was moved by others
    lasted_ = errs_ = 0;
    now_ = state.velocity;
  }
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
    if (columns == 2 && runAlone(from, whole, allowed, world, trial, error)) {
      ++report.accepted;
      report.order = std::max(report.order, 2);
      report.least = report.least > 0 ? std::min(report.least, whole) : whole;
      report.estimate += error;
      left = whole == left ? 0 : left - whole;
      continue;
    }
    error = coarser;
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
    note(whole, columns == 2 ? 4 * error : 0);
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
