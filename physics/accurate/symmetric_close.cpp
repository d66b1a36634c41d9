// Where a symmetric step ends: the joints' pulls that close them there.
#include <limits>

#include "physics/accurate/symmetric_step.h"

namespace physics {

// J M^-1 J^T of a row alone, the sum over its diagonal.
double SymmetricStep::mobilityOf(std::size_t i, const IslandRow& row) const {
  const JointShape& shape = topology_->shapes[i];
  double sum = 0;
  for (int b = 0; b < shape.bodyCount; ++b) {
    if (shape.moves[b]) sum += couple(row, b, row, b, present_.inverse[shape.body[b]]).trace();
  }
  return sum;
}

// A force K = k h^2 + nu h of which the damper is so strong that nothing swings, d > 2 w, is stable
// in steps that do not resolve it, but for a row of one step: the trapezoidal rule takes a velocity
// into its opposite, and (4 R(z/2)^2 - R(z))/3 into 5/3 of it. Rows of 2, 4, 6 ... steps stay
// within 1 and damp.
bool SymmetricStep::dampsWithin(double time, const Surroundings& world, const TrialPoses& trial) {
  JointRow row;
  IslandRow gradient;
  const auto stiffnessAt = [&](std::size_t i, double h) {
    clear(row);
    evaluateRow(world.kinds, refs_[i], {trial.start, trial.start, h, {}, {}, trial.start}, row);
    const bool falls = row.active && row.role == JointRow::Role::kForce;
    return falls ? topology_->shapes[i].rows / row.alpha.trace() : 0;
  };
  bool some = false;
  isDamped_.assign(refs_.size(), false);
  for (std::size_t i = 0; hasForces_ && i < refs_.size(); ++i) {
    if (!isForce_[i]) continue;
    const double once = stiffnessAt(i, time), twice = stiffnessAt(i, 2 * time);
    takeRow(row, gradient);
    const double mobility = mobilityOf(i, gradient) / topology_->shapes[i].rows;
    const double d = mobility * (4 * once - twice) / (2 * time);
    const double squared = mobility * (twice - 2 * once) / (2 * time * time);  // w^2
    isDamped_[i] = d > 0 && d * d >= 4 * squared;
    some = some || (isDamped_[i] && d * time > 1);
  }
  return some;
}

// A spring of w h > 1 is not resolved: of a stiff one steps of different length may agree on what
// is not its motion, and where they do not, what is extrapolated grows.
bool SymmetricStep::resolvesForces() const {
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    const IslandRow& row = present_.rows[i];
    if (!isForce_[i] || !row.solved || isDamped_[i]) continue;
    // alpha^-1 is K (h/2)^2, of which A takes (w h/2)^2.
    if (4 * mobilityOf(i, row) > row.alpha.trace()) return false;
  }
  return true;
}

// Where the step ends by lambda; the largest of what is then open.
double SymmetricStep::tryOut(double h, const Surroundings& world, const TrialPoses& trial) {
  sum();
  if (!move(h, world)) return std::numeric_limits<double>::infinity();
  put(to_, trial.end);
  lookAt(to_, trial.end, trial, world, h);
  lookAtForces(world, trial, h);
  double most = 0;
  for (const Vec3& error : error_) {
    const double open = error.cwiseAbs().maxCoeff();
    if (!(open <= most)) most = open;  // not a number: that
  }
  return most;
}

void SymmetricStep::correct() {
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    if (present_.rows[i].solved) lambda_[i] += error_[i];
  }
}

// Newton's iteration with the factor of the start.
bool SymmetricStep::close(double h, double tolerance, const Surroundings& world,
                          const TrialPoses& trial) {
  constexpr double kSlow = 0.1;  // what the factor of an iteration before leaves too much of
  const RowSystem* factor = &present_.joints;
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostIterations; ++k) {
    const double most = tryOut(h, world, trial);
    if (!(most < std::numeric_limits<double>::infinity())) return false;
    if (most <= tolerance && (k > 0 || !hasForces_)) return true;
    // Less than a bit a try: it has come to rounding, or comes to nothing.
    if (k > 3 && most > 0.5 * last) return most <= 10 * tolerance;
    if (k == 0 && !resolvesForces()) return false;
    if (hasForces_ && (k == 0 || (k == 1 && most > kSlow * last))) {
      all_.factorize(present_.rows, present_.inverse);
      factor = &all_;
    }
    last = most;
    for (Vec3& error : error_) error = -error;
    factor->solve(error_);
    correct();
  }
  return false;
}

// The same with the factor of both ends: past a pose in which the rows of a loop depend on each
// other, J' is on the other side of it than J.
bool SymmetricStep::closeAcross(double h, double tolerance, const Surroundings& world,
                                const TrialPoses& trial) {
  for (int k = 0; k < kMostIterations; ++k) {
    const double most = tryOut(h, world, trial);
    if (!(most < std::numeric_limits<double>::infinity())) return false;
    if (most <= tolerance && k > 0) return true;
    for (std::size_t i = 0; i < refs_.size(); ++i) {
      if (isForce_[i]) takeRow(present_.rows[i], ahead_[i]);
    }
    across_.factorize(ahead_, present_.rows, present_.inverse);
    for (Vec3& error : error_) error = -error;
    across_.solve(error_);
    correct();
  }
  return false;
}

}  // namespace physics
