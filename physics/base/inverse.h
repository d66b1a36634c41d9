// Inverses of small matrices that extreme numbers may make singular.
#pragma once

#include <Eigen/LU>
#include <limits>

namespace physics {

// Of a square matrix of at most four rows; not a number where its determinant rounds to zero, as
// what is computed with it then is not, which a step tells.
template <typename Matrix>
Matrix inverseOrNan(const Matrix& matrix) {
  Matrix inverse;
  bool isRegular = false;
  matrix.computeInverseWithCheck(inverse, isRegular, 0);
  if (!isRegular) inverse.setConstant(std::numeric_limits<double>::quiet_NaN());
  return inverse;
}

}  // namespace physics
