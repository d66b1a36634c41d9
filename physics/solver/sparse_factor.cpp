// Factors of sparse matrices.
#include "physics/solver/sparse_factor.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>

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

}  // namespace

void SparseFactor::layOut(std::span<const std::array<int, 2>> entries) {
  Matrix pattern = patternOf(entries);
  const Matrix both = pattern.selfadjointView<Eigen::Lower>();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(both, order);
  const auto places = order.inverse().eval();
  order_.assign(places.indices().begin(), places.indices().end());
  const auto columnOf = [&](int i, int j) { return std::max(order_[i], order_[j]); };
  columnStarts_.assign(order_.size() + 1, 0);
  for (int j = 0; j < size(); ++j) {
    for (Matrix::InnerIterator at(pattern, j); at; ++at) ++columnStarts_[columnOf(at.row(), j) + 1];
  }
  for (int k = 0; k < size(); ++k) columnStarts_[k + 1] += columnStarts_[k];
  rows_.resize(pattern.nonZeros());
  values_.resize(rows_.size());
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
void SparseFactor::findColumns() {
  const std::size_t count = order_.size();
  parents_.assign(count, -1);
  seenBy_.assign(count, -1);
  reached_.resize(count);
  lengths_.assign(count, 0);
  for (int k = 0; k < size(); ++k) {
    seenBy_[k] = k;
    for (int p = columnStarts_[k]; p < columnStarts_[k + 1]; ++p) {
      for (int i = rows_[p]; seenBy_[i] != k; i = parents_[i]) {
        if (parents_[i] < 0) parents_[i] = k;
        ++lengths_[i];
        seenBy_[i] = k;
      }
    }
  }
  starts_.assign(count + 1, 0);
  for (int k = 0; k < size(); ++k) starts_[k + 1] = starts_[k] + lengths_[k];
  below_.resize(starts_.back());
  lower_.resize(starts_.back());
  diagonal_.resize(count);
  row_.assign(count, 0);
}

void SparseFactor::begin() {
  std::fill(values_.begin(), values_.end(), 0.0);
  next_ = 0;
}

// Row k of A into row_, and the columns of L that have an entry in row k, from the place returned
// to the end of reached_, each after those that it depends on.
int SparseFactor::reach(int k) {
  int top = size();
  seenBy_[k] = k;
  for (int p = columnStarts_[k]; p < columnStarts_[k + 1]; ++p) {
    row_[rows_[p]] += values_[p];
    int length = 0;
    for (int i = rows_[p]; seenBy_[i] != k; i = parents_[i]) {
      reached_[length++] = i;
      seenBy_[i] = k;
    }
    while (length > 0) reached_[--top] = reached_[--length];
  }
  return top;
}

void SparseFactor::factorize() {
  std::fill(lengths_.begin(), lengths_.end(), 0);
  std::fill(seenBy_.begin(), seenBy_.end(), -1);
  for (int k = 0; k < size(); ++k) {
    int top = reach(k);
    double d = row_[k];
    row_[k] = 0;
    for (; top < size(); ++top) {
      const int i = reached_[top], end = starts_[i] + lengths_[i];
      const double value = row_[i], scaled = value / diagonal_[i];
      row_[i] = 0;
      for (int p = starts_[i]; p < end; ++p) row_[below_[p]] -= lower_[p] * value;
      d -= scaled * value;
      below_[end] = k;
      lower_[end] = scaled;
      ++lengths_[i];
    }
    diagonal_[k] = d != 0 ? d : std::numeric_limits<double>::infinity();
  }
}

// By the factor, where it stands in row_.
void SparseFactor::substitute() {
  for (int k = 0; k < size(); ++k) {
    for (int p = starts_[k]; p < starts_[k + 1]; ++p) row_[below_[p]] -= row_[k] * lower_[p];
  }
  for (int k = 0; k < size(); ++k) row_[k] *= 1 / diagonal_[k];
  for (int k = size(); k-- > 0;) {
    for (int p = starts_[k]; p < starts_[k + 1]; ++p) row_[k] -= lower_[p] * row_[below_[p]];
  }
}

// What `solved_` leaves of the right-hand side in row_.
void SparseFactor::subtractProduct() {
  for (int k = 0; k < size(); ++k) {
    for (int p = columnStarts_[k]; p < columnStarts_[k + 1]; ++p) {
      const int i = rows_[p];
      row_[i] -= values_[p] * solved_[k];
      if (i != k) row_[k] -= values_[p] * solved_[i];
    }
  }
}

void SparseFactor::solve(const Eigen::VectorXd& right, Eigen::VectorXd& solution) {
  for (int i = 0; i < size(); ++i) row_[order_[i]] = right[i];
  substitute();
  solution.resize(size());
  for (int i = 0; i < size(); ++i) solution[i] = row_[order_[i]];
  std::fill(row_.begin(), row_.end(), 0.0);
}

void SparseFactor::refine(const Eigen::VectorXd& right, Eigen::VectorXd& solution) {
  solved_.resize(order_.size());
  for (int i = 0; i < size(); ++i) {
    row_[order_[i]] = right[i];
    solved_[order_[i]] = solution[i];
  }
  subtractProduct();
  substitute();
  for (int i = 0; i < size(); ++i) solution[i] += row_[order_[i]];
  std::fill(row_.begin(), row_.end(), 0.0);
}

}  // namespace physics
