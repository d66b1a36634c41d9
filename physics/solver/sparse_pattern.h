// Where the entries of a sparse symmetric matrix and of its triangular factor L are, in the order
// of least degree. What factorizes works row by row of L, up-looking: T. A. Davis, "Algorithm 849:
// a concise sparse Cholesky factorization package", ACM TOMS 31 (2005).
#pragma once

#include <array>
#include <span>
#include <vector>

namespace physics {

class SparsePattern {
 public:
  // (row, column) of the lower triangle, in the order that their values will be given in; what is
  // named twice is summed. Every diagonal entry is among them. Allocates, and nothing else does.
  void layOut(std::span<const std::array<int, 2>> entries);
  void forget() { order_.clear(); }
  bool isLaidOut() const { return !order_.empty(); }
  int size() const { return static_cast<int>(order_.size()); }
  int placeOf(int row) const { return order_[row]; }             // in the order of elimination
  int slotOf(std::size_t entry) const { return slots_[entry]; }  // among the matrix' values
  std::size_t slotCount() const { return rows_.size(); }
  std::size_t lowerCount() const { return below_.size(); }  // of L without its diagonal
  double fill() const;  // the length of L's columns, squared, on the average

  // Column k of the upper triangle: f(row, slot).
  template <class F>
  void forEachAbove(int k, F&& f) const {
    for (int p = columnStarts_[k]; p < columnStarts_[k + 1]; ++p) f(rows_[p], p);
  }

  // Of L's columns, which are filled row by row.
  void beginFilling();
  // The columns that have an entry in row k, each after those that it depends on.
  std::span<const int> reach(int k);
  int append(int column, int row);  // where the entry goes
  int start(int column) const { return starts_[column]; }
  int end(int column) const { return starts_[column] + filled_[column]; }
  int rowAt(int at) const { return below_[at]; }
  const int* rowsFrom(int at) const { return below_.data() + at; }

 private:
  void findColumns();

  std::vector<int> order_;  // place of each row in the order of elimination
  std::vector<int> columnStarts_, rows_, slots_;
  std::vector<int> parents_;  // the tree of elimination, -1: a root
  std::vector<int> starts_, filled_, below_;
  std::vector<int> reached_, seenBy_;
};

}  // namespace physics
