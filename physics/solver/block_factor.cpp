// Factors of sparse matrices of blocks.
#include "physics/solver/block_factor.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace physics {

void BlockFactor::layOut(std::span<const std::array<int, 2>> entries) {
  pattern_.layOut(entries);
  values_.resize(pattern_.slotCount());
  lower_.resize(pattern_.lowerCount());
  inverse_.resize(size());
  row_.assign(size(), Mat3::Zero());
  solved_.resize(size());
}

void BlockFactor::begin() {
  std::fill(values_.begin(), values_.end(), Mat3::Zero());
  next_ = 0;
}

void BlockFactor::factorize() {
  pattern_.beginFilling();
  for (int k = 0; k < size(); ++k) {
    pattern_.forEachAbove(k, [&](int row, int slot) { row_[row] += values_[slot]; });
    Mat3 own = row_[k];
    row_[k].setZero();
    for (const int i : pattern_.reach(k)) {
      Mat3 block;
      block.noalias() = inverse_[i].lazyProduct(row_[i]);
      row_[i].setZero();
      for (int p = pattern_.start(i); p < pattern_.end(i); ++p) {
        row_[pattern_.rowAt(p)].noalias() -= lower_[p].lazyProduct(block);
      }
      own.noalias() -= block.transpose().lazyProduct(block);
      lower_[pattern_.append(i, k)] = block.transpose();
    }
    inverse_[k].setIdentity();
    Eigen::LLT<Mat3>(own).matrixL().solveInPlace(inverse_[k]);
  }
}

void BlockFactor::solve(std::span<Vec3> x) {
  for (int i = 0; i < size(); ++i) solved_[pattern_.placeOf(i)] = x[i];
  for (int k = 0; k < size(); ++k) {
    solved_[k] = inverse_[k].lazyProduct(solved_[k]).eval();
    for (int p = pattern_.start(k); p < pattern_.end(k); ++p) {
      solved_[pattern_.rowAt(p)].noalias() -= lower_[p].lazyProduct(solved_[k]);
    }
  }
  for (int k = size(); k-- > 0;) {
    for (int p = pattern_.start(k); p < pattern_.end(k); ++p) {
      solved_[k].noalias() -= lower_[p].transpose().lazyProduct(solved_[pattern_.rowAt(p)]);
    }
    solved_[k] = inverse_[k].transpose().lazyProduct(solved_[k]).eval();
  }
  for (int i = 0; i < size(); ++i) x[i] = solved_[pattern_.placeOf(i)];
}

}  // namespace physics
