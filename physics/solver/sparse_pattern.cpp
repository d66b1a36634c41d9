// The order of elimination, and what fills up.
#include "physics/solver/sparse_pattern.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace physics {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

Matrix patternOf(std::span<const std::array<int, 2>> entries) {
  std::vector<Eigen::Triplet<double>> ones;
  int size = 0;
  for (const auto& [row, column] : entries) {
    ones.emplace_back(row, column, 1.0);
    size = std::max(size, row + 1);
  }
  Matrix pattern(size, size);
  pattern.setFromTriplets(ones.begin(), ones.end());
  return pattern;
}

std::vector<int> orderOf(const Matrix& pattern) {
  const Matrix both = pattern.selfadjointView<Eigen::Lower>();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(both, order);
  return {order.indices().begin(), order.indices().end()};
}

}  // namespace

void SparsePattern::layOut(std::span<const std::array<int, 2>> entries) {
  Matrix pattern = patternOf(entries);
  const std::vector<int> order = orderOf(pattern);
  order_.resize(order.size());
  for (int k = 0; k < size(); ++k) order_[order[k]] = k;
  const auto columnOf = [&](int i, int j) { return std::max(order_[i], order_[j]); };
  columnStarts_.assign(order_.size() + 1, 0);
  for (int j = 0; j < size(); ++j) {
    for (Matrix::InnerIterator at(pattern, j); at; ++at) ++columnStarts_[columnOf(at.row(), j) + 1];
  }
  for (int k = 0; k < size(); ++k) columnStarts_[k + 1] += columnStarts_[k];
  rows_.resize(pattern.nonZeros());
  std::vector<int> ends(columnStarts_.begin(), columnStarts_.end() - 1);
  for (int j = 0; j < size(); ++j) {
    for (Matrix::InnerIterator at(pattern, j); at; ++at) {
      const int slot = ends[columnOf(at.row(), j)]++;
      rows_[slot] = std::min(order_[at.row()], order_[j]);
      at.valueRef() = slot;
    }
  }
  slots_.clear();
  for (const auto& [row, column] : entries) {
    slots_.push_back(static_cast<int>(pattern.coeff(row, column)));
  }
  findColumns();
}

// The tree of elimination, and the length of L's columns: row k of L has what is reached in the
// tree from the entries of A's row k.
void SparsePattern::findColumns() {
  const std::size_t count = order_.size();
  parents_.assign(count, -1);
  seenBy_.assign(count, -1);
  reached_.resize(count);
  filled_.assign(count, 0);
  for (int k = 0; k < size(); ++k) {
    seenBy_[k] = k;
    for (int p = columnStarts_[k]; p < columnStarts_[k + 1]; ++p) {
      for (int i = rows_[p]; seenBy_[i] != k; i = parents_[i]) {
        if (parents_[i] < 0) parents_[i] = k;
        ++filled_[i];
        seenBy_[i] = k;
      }
    }
  }
  starts_.assign(count + 1, 0);
  for (int k = 0; k < size(); ++k) starts_[k + 1] = starts_[k] + filled_[k];
  below_.resize(starts_.back());
}

double SparsePattern::fill() const {
  double sum = 0;
  for (int k = 0; k < size(); ++k) {
    const double length = starts_[k + 1] - starts_[k] + 1;
    sum += length * length;
  }
  return size() > 0 ? sum / size() : 0;
}

void SparsePattern::beginFilling() {
  std::fill(filled_.begin(), filled_.end(), 0);
  std::fill(seenBy_.begin(), seenBy_.end(), -1);
}

std::span<const int> SparsePattern::reach(int k) {
  int top = size();
  seenBy_[k] = k;
  for (int p = columnStarts_[k]; p < columnStarts_[k + 1]; ++p) {
    int length = 0;
    for (int i = rows_[p]; seenBy_[i] != k; i = parents_[i]) {
      reached_[length++] = i;
      seenBy_[i] = k;
    }
    while (length > 0) reached_[--top] = reached_[--length];
  }
  return std::span<const int>(reached_).subspan(top);
}

int SparsePattern::append(int column, int row) {
  const int at = end(column);
  below_[at] = row;
  ++filled_[column];
  return at;
}

}  // namespace physics
