// The blocks of BlockFactor as its kernels see them: arrays, without Eigen.
#pragma once

namespace physics {

// By columns, which begin at whole registers of four numbers: zero beyond N.
template <int N>
struct alignas(32) PaddedBlock {
  static constexpr int kStride = (N + 3) / 4 * 4;
  static constexpr int kSize = N * kStride;
  double of[kSize] = {};
};

// row[at[p]] -= lower[p] block
template <int N>
using SubtractProducts = void (*)(PaddedBlock<N>* row, const PaddedBlock<N>* lower, const int* at,
                                  int count, const PaddedBlock<N>& block);
struct BlockKernels {
  SubtractProducts<3> three;
  SubtractProducts<6> six;
};
extern const BlockKernels kBlockKernelsSse2, kBlockKernelsAvx2;

}  // namespace physics
