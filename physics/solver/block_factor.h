// L L^T of a sparse positive definite matrix of 3 x 3 blocks whose values change often and its
// pattern seldom: laying it out allocates, factorizing and solving do not. Blocks on the diagonal
// are taken apart as well, and not inverted: where what holds is 1e7 times as stiff as the mass is
// heavy, an inverse has lost all that the mass says.
#pragma once

#include "physics/base/types.h"
#include "physics/solver/sparse_pattern.h"

namespace physics {

// By columns, four numbers apart: one register each.
struct alignas(32) PaddedBlock {
  double of[12] = {};
  auto matrix() { return Eigen::Map<Mat3, 0, Eigen::OuterStride<4>>(of); }
  auto matrix() const { return Eigen::Map<const Mat3, 0, Eigen::OuterStride<4>>(of); }
};

// row[at[p]] -= lower[p] block
using SubtractProducts = void (*)(PaddedBlock* row, const PaddedBlock* lower, const int* at,
                                  int count, const PaddedBlock& block);
extern const SubtractProducts kSubtractProductsSse2, kSubtractProductsAvx2;

class BlockFactor {
 public:
  void layOut(std::span<const std::array<int, 2>> entries);
  int size() const { return pattern_.size(); }
  double fill() const { return pattern_.fill(); }

  void begin();  // of giving values, which follow in the order of the entries
  void give(const Mat3& block);
  void factorize();
  void solve(std::span<Vec3> x);  // from the right-hand side, in place
  // Of several right-hand sides, side by side: L is read once for all of them.
  static constexpr int kSides = 8;
  using Sides = Eigen::Matrix<double, 3, kSides, Eigen::RowMajor>;  // its rows in registers
  void solve(std::span<Sides> x);

 private:
  template <class X>
  void substitute(std::span<X> x, std::vector<X>& solved) const;

  SparsePattern pattern_;
  std::vector<bool> isTurned_;  // by entry: its column is eliminated before its row
  std::vector<Mat3> values_;    // of the upper triangle, in the order of elimination
  std::size_t next_ = 0;
  std::vector<PaddedBlock> lower_;  // of L
  std::vector<Mat3> inverse_;       // of its diagonal, inverse: triangular
  std::vector<PaddedBlock> row_;    // scratch: zero but within a row of factorize
  std::vector<Vec3> solved_;
  std::vector<Sides> solvedSides_;
};

}  // namespace physics
