// Pseudo-inverse by singular values.
#include "physics/kinematics/pseudo_inverse.h"

#include <Eigen/SVD>
#include <algorithm>

namespace physics {

Eigen::MatrixXd pseudoInverse(const Eigen::MatrixXd& a, double cutoff) {
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(a.cols(), a.rows());
  if (a.size() == 0) return inverse;
  // Made square by zeros, which have the singular value 0: nothing is to be decomposed before.
  const Eigen::Index side = std::max(a.rows(), a.cols());
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(side, side);
  square.topLeftCorner(a.rows(), a.cols()) = a;
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(
      square, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::VectorXd& sigma = svd.singularValues();
  for (Eigen::Index k = 0; k < side && sigma[k] > cutoff * sigma[0]; ++k) {
    inverse += svd.matrixV().col(k).head(a.cols()) / sigma[k] *
               svd.matrixU().col(k).head(a.rows()).transpose();
  }
  return inverse;
}

Eigen::VectorXd leastMultipliers(const Eigen::MatrixXd& j, const Eigen::VectorXd& c) {
  return -pseudoInverse(j.lazyProduct(j.transpose())) * c;
}

Eigen::VectorXd leastStep(const Eigen::MatrixXd& j, const Eigen::VectorXd& c) {
  return -pseudoInverse(j) * c;
}

}  // namespace physics
