// What factorizing by blocks does most, for the registers that its file is compiled for: included
// by block_sse2.cpp and block_avx2.cpp alone. Both give the same bytes.
#include <cstring>

#include "physics/solver/padded_block.h"

namespace physics {
namespace {

using Column = double __attribute__((vector_size(32)));

void load(const double* from, Column& to) { std::memcpy(&to, from, sizeof to); }

template <int N>
void subtractProducts(PaddedBlock<N>* row, const PaddedBlock<N>* lower, const int* at, int count,
                      const PaddedBlock<N>& block) {
  constexpr int kStride = PaddedBlock<N>::kStride;
  for (int p = 0; p < count; ++p) {
    for (int part = 0; part < kStride; part += 4) {  // of the rows
      const double* const l = lower[p].of + part;
      Column columns[N];
      for (int k = 0; k < N; ++k) load(l + k * kStride, columns[k]);
      double* const to = row[at[p]].of + part;
      for (int j = 0; j < N; ++j) {
        const double* b = block.of + kStride * j;
        Column product = columns[0] * b[0], sum;
        for (int k = 1; k < N; ++k) product += columns[k] * b[k];
        load(to + kStride * j, sum);
        sum -= product;
        std::memcpy(to + kStride * j, &sum, sizeof sum);
      }
    }
  }
}

}  // namespace

const BlockKernels KERNELS = {subtractProducts<3>, subtractProducts<6>};

}  // namespace physics
