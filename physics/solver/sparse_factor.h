// L D L^T of a sparse symmetric matrix whose values change often and its pattern seldom: laying it
// out allocates, factorizing and solving do not.
#pragma once

#include <Eigen/Core>

#include "physics/solver/sparse_pattern.h"

namespace physics {

class SparseFactor {
 public:
  void layOut(std::span<const std::array<int, 2>> entries);
  void forget() { pattern_.forget(); }
  bool isLaidOut() const { return pattern_.isLaidOut(); }
  int size() const { return pattern_.size(); }

  void begin();  // of giving values, which follow in the order of the entries
  void give(double value) { values_[pattern_.slotOf(next_++)] += value; }
  // False where a pivot is zero; what it stands for does not move.
  bool factorize();
  void solve(const Eigen::VectorXd& right, Eigen::VectorXd& solution);
  void refine(const Eigen::VectorXd& right, Eigen::VectorXd& solution);  // by what it leaves

 private:
  void substitute();
  void subtractProduct();

  SparsePattern pattern_;
  std::vector<double> values_;
  std::size_t next_ = 0;
  std::vector<double> lower_, diagonal_;
  std::vector<double> row_;  // scratch: zero but within a row of factorize
  std::vector<double> solved_;
};

}  // namespace physics
