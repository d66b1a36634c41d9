// Factors of sparse matrices of blocks.
#include "physics/solver/block_factor.h"

#include <algorithm>
#include <cmath>

namespace physics {

namespace {

// L^-1 of a = L L^T.
Mat3 inverseOfLower(const Mat3& a) {
  const double l00 = std::sqrt(a(0, 0)), i00 = 1 / l00;
  const double l10 = a(1, 0) * i00, l20 = a(2, 0) * i00;
  const double i11 = 1 / std::sqrt(a(1, 1) - l10 * l10);
  const double l21 = (a(2, 1) - l20 * l10) * i11;
  const double i22 = 1 / std::sqrt(a(2, 2) - l20 * l20 - l21 * l21);
  Mat3 inverse = Mat3::Zero();
  inverse(0, 0) = i00;
  inverse(1, 1) = i11;
  inverse(2, 2) = i22;
  inverse(1, 0) = -l10 * i00 * i11;
  inverse(2, 1) = -l21 * i11 * i22;
  inverse(2, 0) = -(l20 * i00 + l21 * inverse(1, 0)) * i22;
  return inverse;
}

template <class M>
void subtract(Vec3& from, const M& block, const Vec3& x) {
  from.noalias() -= block.lazyProduct(x);
}

// Row by row, all sides at once.
template <class M>
void subtract(BlockFactor::Sides& from, const M& block, const BlockFactor::Sides& x) {
  for (int i = 0; i < 3; ++i) {
    const double a = block(i, 0), b = block(i, 1), c = block(i, 2);
    from.row(i).array() -= a * x.row(0).array() + b * x.row(1).array() + c * x.row(2).array();
  }
}

template <class M, class X>
X product(const M& block, const X& x) {
  X negative = X::Zero();
  subtract(negative, block, x);
  return -negative;
}

}  // namespace

void BlockFactor::layOut(std::span<const std::array<int, 2>> entries) {
  pattern_.layOut(entries);
  isTurned_.clear();
  for (const auto& [row, column] : entries) {
    isTurned_.push_back(pattern_.placeOf(column) < pattern_.placeOf(row));
  }
  values_.resize(pattern_.slotCount());
  lower_.resize(pattern_.lowerCount());
  inverse_.resize(size());
  row_.assign(size(), {});
  solved_.resize(size());
}

void BlockFactor::begin() {
  std::fill(values_.begin(), values_.end(), Mat3::Zero());
  next_ = 0;
}

void BlockFactor::give(const Mat3& block) {
  Mat3& value = values_[pattern_.slotOf(next_)];
  if (isTurned_[next_++]) {
    value += block.transpose();
  } else {
    value += block;
  }
}

void BlockFactor::factorize() {
  static const bool isWide = __builtin_cpu_supports("avx2");
  const SubtractProducts subtractProducts = isWide ? kSubtractProductsAvx2 : kSubtractProductsSse2;
  pattern_.beginFilling();
  for (int k = 0; k < size(); ++k) {
    pattern_.forEachAbove(k, [&](int row, int slot) { row_[row].matrix() += values_[slot]; });
    Mat3 own = row_[k].matrix();
    row_[k] = {};
    for (const int i : pattern_.reach(k)) {
      PaddedBlock block;
      block.matrix().noalias() = inverse_[i].lazyProduct(row_[i].matrix());
      row_[i] = {};
      const int start = pattern_.start(i), count = pattern_.end(i) - start;
      subtractProducts(row_.data(), lower_.data() + start, pattern_.rowsFrom(start), count, block);
      own.noalias() -= block.matrix().transpose().lazyProduct(block.matrix());
      lower_[pattern_.append(i, k)].matrix() = block.matrix().transpose();
    }
    inverse_[k] = inverseOfLower(own);
  }
}

template <class X>
void BlockFactor::substitute(std::span<X> x, std::vector<X>& solved) const {
  solved.resize(size());
  for (int i = 0; i < size(); ++i) solved[pattern_.placeOf(i)] = x[i];
  for (int k = 0; k < size(); ++k) {
    solved[k] = product(inverse_[k], solved[k]);
    for (int p = pattern_.start(k); p < pattern_.end(k); ++p) {
      subtract(solved[pattern_.rowAt(p)], lower_[p].matrix(), solved[k]);
    }
  }
  for (int k = size(); k-- > 0;) {
    for (int p = pattern_.start(k); p < pattern_.end(k); ++p) {
      subtract(solved[k], lower_[p].matrix().transpose(), solved[pattern_.rowAt(p)]);
    }
    solved[k] = product(inverse_[k].transpose(), solved[k]);
  }
  for (int i = 0; i < size(); ++i) x[i] = solved[pattern_.placeOf(i)];
}

void BlockFactor::solve(std::span<Vec3> x) { substitute(x, solved_); }
void BlockFactor::solve(std::span<Sides> x) { substitute(x, solvedSides_); }

}  // namespace physics
