// Factors of sparse matrices.
#include "physics/solver/sparse_factor.h"

#include <algorithm>
#include <limits>

namespace physics {

void SparseFactor::layOut(std::span<const std::array<int, 2>> entries) {
  pattern_.layOut(entries);
  values_.resize(pattern_.slotCount());
  lower_.resize(pattern_.lowerCount());
  diagonal_.resize(size());
  row_.assign(size(), 0);
}

void SparseFactor::begin() {
  std::fill(values_.begin(), values_.end(), 0.0);
  next_ = 0;
}

bool SparseFactor::factorize() {
  bool isRegular = true;
  pattern_.beginFilling();
  for (int k = 0; k < size(); ++k) {
    pattern_.forEachAbove(k, [&](int row, int slot) { row_[row] += values_[slot]; });
    double d = row_[k];
    row_[k] = 0;
    for (const int i : pattern_.reach(k)) {
      const double value = row_[i], scaled = value / diagonal_[i];
      row_[i] = 0;
      const int start = pattern_.start(i), count = pattern_.end(i) - start;
      const int* below = pattern_.rowsFrom(start);
      const double* lower = lower_.data() + start;
      for (int p = 0; p < count; ++p) row_[below[p]] -= lower[p] * value;
      d -= scaled * value;
      lower_[pattern_.append(i, k)] = scaled;
    }
    isRegular = isRegular && d != 0;
    diagonal_[k] = d != 0 ? d : std::numeric_limits<double>::infinity();
  }
  return isRegular;
}

// By the factor, where it stands in row_.
void SparseFactor::substitute() {
  for (int k = 0; k < size(); ++k) {
    for (int p = pattern_.start(k); p < pattern_.end(k); ++p) {
      row_[pattern_.rowAt(p)] -= row_[k] * lower_[p];
    }
  }
  for (int k = 0; k < size(); ++k) row_[k] *= 1 / diagonal_[k];
  for (int k = size(); k-- > 0;) {
    for (int p = pattern_.start(k); p < pattern_.end(k); ++p) {
      row_[k] -= lower_[p] * row_[pattern_.rowAt(p)];
    }
  }
}

// What `solved_` leaves of the right-hand side in row_.
void SparseFactor::subtractProduct() {
  for (int k = 0; k < size(); ++k) {
    pattern_.forEachAbove(k, [&](int i, int slot) {
      row_[i] -= values_[slot] * solved_[k];
      if (i != k) row_[k] -= values_[slot] * solved_[i];
    });
  }
}

void SparseFactor::solve(const Eigen::VectorXd& right, Eigen::VectorXd& solution) {
  for (int i = 0; i < size(); ++i) row_[pattern_.placeOf(i)] = right[i];
  substitute();
  solution.resize(size());
  for (int i = 0; i < size(); ++i) solution[i] = row_[pattern_.placeOf(i)];
  std::fill(row_.begin(), row_.end(), 0.0);
}

void SparseFactor::refine(const Eigen::VectorXd& right, Eigen::VectorXd& solution) {
  solved_.resize(size());
  for (int i = 0; i < size(); ++i) {
    row_[pattern_.placeOf(i)] = right[i];
    solved_[pattern_.placeOf(i)] = solution[i];
  }
  subtractProduct();
  substitute();
  for (int i = 0; i < size(); ++i) solution[i] += row_[pattern_.placeOf(i)];
  std::fill(row_.begin(), row_.end(), 0.0);
}

}  // namespace physics
