// L L^T of a sparse positive definite matrix of blocks, 3 x 3 of points or 6 x 6 of bodies, whose
// values change often and its pattern seldom: laying it out allocates, factorizing and solving do
// not. Blocks on the diagonal are taken apart as well, and not inverted: where what holds is 1e7
// times as stiff as the mass is heavy, an inverse has lost all that the mass says.
#pragma once

#include "physics/base/types.h"
#include "physics/solver/padded_block.h"
#include "physics/solver/sparse_pattern.h"

namespace physics {

template <int N, class Matrix>
using BlockMap = Eigen::Map<Matrix, Eigen::Aligned32, Eigen::OuterStride<PaddedBlock<N>::kStride>>;
template <int N>
auto matrixOf(PaddedBlock<N>& block) {
  return BlockMap<N, Eigen::Matrix<double, N, N>>(block.of);
}
template <int N>
auto matrixOf(const PaddedBlock<N>& block) {
  return BlockMap<N, const Eigen::Matrix<double, N, N>>(block.of);
}

template <int N>
class BlockFactor {
 public:
  using Matrix = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, N, 1>;

  void layOut(std::span<const std::array<int, 2>> entries);
  int size() const { return pattern_.size(); }
  double fill() const { return pattern_.fill(); }

  // Sums of values, by entry. Of what is turned, the block of (column, row).
  void begin();
  PaddedBlock<N>& value(std::size_t entry) { return values_[pattern_.slotOf(entry)]; }
  bool isTurned(std::size_t entry) const { return isTurned_[entry]; }
  void give(const Matrix& block);   // to the next entry in order
  void keep() { kept_ = values_; }  // values, to go on from there again
  void takeKept();
  void factorize();
  void solve(std::span<Vector> x);  // from the right-hand side, in place
  // Of several right-hand sides, side by side: L is read once for all of them.
  static constexpr int kSides = 8;
  using Sides = Eigen::Matrix<double, N, kSides, Eigen::RowMajor>;  // its rows in registers
  void solve(std::span<Sides> x);

 private:
  template <class X>
  void substitute(std::span<X> x, std::vector<X>& solved) const;

  SparsePattern pattern_;
  std::vector<bool> isTurned_;  // by entry: its column is eliminated before its row
  // Of the upper triangle, in the order of elimination.
  std::vector<PaddedBlock<N>> values_, kept_;
  std::size_t next_ = 0;
  std::vector<PaddedBlock<N>> lower_;    // of L
  std::vector<PaddedBlock<N>> inverse_;  // of its diagonal, inverse: triangular
  std::vector<PaddedBlock<N>> row_;      // scratch: zero but within a row of factorize
  std::vector<Vector> solved_;
  std::vector<Sides> solvedSides_;
};

}  // namespace physics
