// L D L^T of a sparse symmetric matrix whose values change often and its pattern seldom: laying it
// out allocates, factorizing and solving do not. Up-looking, after LDL: T. A. Davis, "Algorithm
// 849: a concise sparse Cholesky factorization package", ACM TOMS 31 (2005); in the order of least
// degree.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace physics {

class SparseFactor {
 public:
  // (row, column) of the lower triangle, in the order that their values will be given in; what is
  // named twice is summed. Every diagonal entry is among them.
  void layOut(std::span<const std::array<int, 2>> entries);
  void forget() { order_.clear(); }
  bool isLaidOut() const { return !order_.empty(); }
  int size() const { return static_cast<int>(order_.size()); }
  int lengthOf(int column) const { return starts_[column + 1] - starts_[column]; }  // of L

  void begin();  // of giving values, which follow in their order
  void give(double value) { values_[slots_[next_++]] += value; }
  void factorize();  // a zero pivot moves nothing
  void solve(const Eigen::VectorXd& right, Eigen::VectorXd& solution);
  void refine(const Eigen::VectorXd& right, Eigen::VectorXd& solution);  // by what it leaves

 private:
  void findColumns();
  int reach(int k);
  void substitute();
  void subtractProduct();

  std::vector<int> order_;  // place of each row in the order of elimination
  // Columns of the upper triangle in that order, and where each entry given goes.
  std::vector<int> columnStarts_, rows_, slots_;
  std::vector<double> values_;
  std::size_t next_ = 0;
  std::vector<int> parents_;           // the tree of elimination, -1: a root
  std::vector<int> starts_, lengths_;  // of the columns of L, and how far they are filled
  std::vector<int> below_;
  std::vector<double> lower_, diagonal_;
  std::vector<double> row_;  // scratch: zero but within a row of factorize
  std::vector<double> solved_;
  std::vector<int> reached_, seenBy_;
};

}  // namespace physics
