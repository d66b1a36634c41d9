// Pseudo-inverse by singular values.
#include "physics/kinematics/pseudo_inverse.h"

#include <Eigen/SVD>

namespace physics {

Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& a, double cutoff) {
  if (a.size() == 0) return Eigen::MatrixXd::Zero(a.cols(), a.rows());
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const double least = cutoff * svd.singularValues()[0];
  const Eigen::VectorXd inverse = svd.singularValues().unaryExpr(
      [least](double sigma) { return sigma > least ? 1 / sigma : 0.0; });
  return svd.matrixV() * inverse.asDiagonal() * svd.matrixU().transpose();
}

Eigen::VectorXd leastMultipliers(const Eigen::MatrixXd& j, const Eigen::VectorXd& c) {
  return -pseudoInverse(j * j.transpose()) * c;
}

Eigen::VectorXd leastStep(const Eigen::MatrixXd& j, const Eigen::VectorXd& c) {
  return -pseudoInverse(j) * c;
}

}  // namespace physics
