// Factors of sparse matrices of blocks.
#include "physics/solver/block_factor.h"

#include <algorithm>
#include <cmath>

namespace physics {

namespace {

// L^-1 of a = L L^T.
template <int N>
void invertLower(const PaddedBlock<N>& a, PaddedBlock<N>& inverse) {
  double l[N][N], x[N][N];
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = matrixOf(a)(i, j);
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = j < i ? sum * x[j][j] : 0;
      if (j == i) x[i][i] = 1 / std::sqrt(sum);
    }
  }
  for (int j = 0; j < N; ++j) {
    for (int i = j + 1; i < N; ++i) {
      double sum = l[i][j] * x[j][j];
      for (int k = j + 1; k < i; ++k) sum += l[i][k] * x[k][j];
      x[i][j] = -sum * x[i][i];
    }
    for (int i = 0; i < N; ++i) matrixOf(inverse)(i, j) = i < j ? 0 : x[i][j];
  }
}

template <int N, class M>
void subtract(Eigen::Matrix<double, N, 1>& from, const M& block,
              const Eigen::Matrix<double, N, 1>& x) {
  from.noalias() -= block.lazyProduct(x);
}

// Row by row, all sides at once.
template <int N, class M>
void subtract(Eigen::Matrix<double, N, BlockFactor<N>::kSides, Eigen::RowMajor>& from,
              const M& block,
              const Eigen::Matrix<double, N, BlockFactor<N>::kSides, Eigen::RowMajor>& x) {
  for (int i = 0; i < N; ++i) {
    Eigen::Array<double, 1, BlockFactor<N>::kSides> sum = block(i, 0) * x.row(0).array();
    for (int k = 1; k < N; ++k) sum += block(i, k) * x.row(k).array();
    from.row(i).array() -= sum;
  }
}

template <int N, class M, class X>
X product(const M& block, const X& x) {
  X negative = X::Zero();
  subtract<N>(negative, block, x);
  return -negative;
}

// What the processor has.
template <int N>
SubtractProducts<N> kernel() {
  static const bool isWide = __builtin_cpu_supports("avx2");
  const BlockKernels& kernels = isWide ? kBlockKernelsAvx2 : kBlockKernelsSse2;
  if constexpr (N == 3) {
    return kernels.three;
  } else {
    return kernels.six;
  }
}

}  // namespace

template <int N>
void BlockFactor<N>::layOut(std::span<const std::array<int, 2>> entries) {
  pattern_.layOut(entries);
  isTurned_.clear();
  for (const auto& [row, column] : entries) {
    isTurned_.push_back(pattern_.placeOf(column) < pattern_.placeOf(row));
  }
  values_.resize(pattern_.slotCount());
  inverse_.resize(size());
  row_.assign(size(), {});
  solved_.resize(size());
}

template <int N>
void BlockFactor<N>::begin() {
  std::fill(values_.begin(), values_.end(), PaddedBlock<N>{});
  next_ = 0;
}

template <int N>
void BlockFactor<N>::give(const Matrix& block) {
  const std::size_t entry = next_++;
  if (isTurned(entry)) {
    matrixOf(value(entry)) += block.transpose();
  } else {
    matrixOf(value(entry)) += block;
  }
}

template <int N>
void BlockFactor<N>::takeKept() {
  std::copy(kept_.begin(), kept_.end(), values_.begin());
}

template <int N>
void BlockFactor<N>::factorize() {
  const SubtractProducts<N> subtractProducts = kernel<N>();
  const int first = 0;
  lower_.resize(pattern_.lowerCount());  // not before: who asks for fill() may think better of it
  pattern_.beginFilling();
  PaddedBlock<N> block;
  for (int k = 0; k < size(); ++k) {
    pattern_.forEachAbove(k, [&](int row, int slot) {
      for (int e = 0; e < PaddedBlock<N>::kSize; ++e) row_[row].of[e] += values_[slot].of[e];
    });
    for (const int i : pattern_.reach(k)) {
      const int start = pattern_.start(i), count = pattern_.end(i) - start;
      block = {};
      subtractProducts(&block, &inverse_[i], &first, 1, row_[i]);
      row_[i] = {};
      for (double& entry : block.of) entry = -entry;
      PaddedBlock<N>& lower = lower_[pattern_.append(i, k)];
      matrixOf(lower) = matrixOf(block).transpose();
      subtractProducts(row_.data(), lower_.data() + start, pattern_.rowsFrom(start), count, block);
      subtractProducts(&row_[k], &lower, &first, 1, block);
    }
    invertLower(row_[k], inverse_[k]);
    row_[k] = {};
  }
}

template <int N>
template <class X>
void BlockFactor<N>::substitute(std::span<X> x, std::vector<X>& solved) const {
  solved.resize(size());
  for (int i = 0; i < size(); ++i) solved[pattern_.placeOf(i)] = x[i];
  for (int k = 0; k < size(); ++k) {
    solved[k] = product<N>(matrixOf(inverse_[k]), solved[k]);
    for (int p = pattern_.start(k); p < pattern_.end(k); ++p) {
      subtract<N>(solved[pattern_.rowAt(p)], matrixOf(lower_[p]), solved[k]);
    }
  }
  for (int k = size(); k-- > 0;) {
    for (int p = pattern_.start(k); p < pattern_.end(k); ++p) {
      subtract<N>(solved[k], matrixOf(lower_[p]).transpose(), solved[pattern_.rowAt(p)]);
    }
    solved[k] = product<N>(matrixOf(inverse_[k]).transpose(), solved[k]);
  }
  for (int i = 0; i < size(); ++i) x[i] = solved[pattern_.placeOf(i)];
}

template <int N>
void BlockFactor<N>::solve(std::span<Vector> x) {
  substitute(x, solved_);
}
template <int N>
void BlockFactor<N>::solve(std::span<Sides> x) {
  substitute(x, solvedSides_);
}

template class BlockFactor<3>;
template class BlockFactor<6>;

}  // namespace physics
