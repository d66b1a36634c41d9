// Where a symmetric step ends: the joints' pulls that close them there.
#include <limits>

#include "physics/accurate/symmetric_step.h"

namespace physics {

// A spring of w h > 1 is not resolved: of a stiff one steps of different length may agree on what
// is not its motion, and where they do not, what is extrapolated grows.
bool SymmetricStep::resolvesForces() const {
  for (std::size_t i = 0; i < refs_.size(); ++i) {
    const IslandRow& row = present_.rows[i];
    if (!isForce_[i] || !row.solved) continue;
    const JointShape& shape = topology_->shapes[i];
    Mat3 a = Mat3::Zero();
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      const BodyInverse& body = present_.inverse[shape.body[b]];
      a += body.mass * (row.linear[b] * row.linear[b].transpose()) +
           row.angular[b] * (body.inertia * row.angular[b].transpose());
    }
    // alpha^-1 is K (h/2)^2, of which A takes (w h/2)^2.
    double compliance = 0, moves = 0;
    for (int r = 0; r < shape.rows; ++r) compliance += row.alpha(r, r), moves += a(r, r);
    if (4 * moves > compliance) return false;
  }
  return true;
}

// Where the step ends by lambda; the largest of what is then open.
double SymmetricStep::tryOut(double h, const Surroundings& world, const TrialPoses& trial) {
  sum();
  move(h, world);
  put(to_, trial.end);
  lookAt(trial.end, trial, world, h);
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
  const RowSystem* factor = &present_.joints;
  double last = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostIterations; ++k) {
    const double most = tryOut(h, world, trial);
    if (!(most < std::numeric_limits<double>::infinity())) return false;
    if (most <= tolerance && (k > 0 || !hasForces_)) return true;
    if (k > 3 && most > 0.5 * last) return most <= 10 * tolerance;
    last = most;
    if (k == 0 && !resolvesForces()) return false;
    if (hasForces_ && k < 2) {
      all_.factorize(present_.rows, present_.inverse);
      factor = &all_;
    }
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
