// The Moore-Penrose inverse, and the step to c + J dX = 0 that changes X least: what an arm with
// M = 1 does, for any number of rows.
#pragma once

#include <Eigen/Core>

namespace physics {

// A^T (A A^T)^-1 where the rows of A are independent (144), the inverse where A is square; by
// singular values, of which those below `cutoff` times the largest count as zero, so that a
// row that says the same twice does no harm.
Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& a, double cutoff = 1e-12);

// -(J J^T)^-1 c. (147)
Eigen::VectorXd leastMultipliers(const Eigen::MatrixXd& j, const Eigen::VectorXd& c);

// The smallest dX with c + J dX = 0, or the smallest of those nearest to it: (143),(145),(148), the
// minimum of (146).
Eigen::VectorXd leastStep(const Eigen::MatrixXd& j, const Eigen::VectorXd& c);

}  // namespace physics
