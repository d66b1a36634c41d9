// What factorizing by blocks does most, for the registers that its file is compiled for: included
// by block_sse2.cpp and block_avx2.cpp alone. Both give the same bytes.
#include <cstring>

#include "physics/solver/block_factor.h"

namespace physics {
namespace {

using Column = double __attribute__((vector_size(32)));

void load(const double* from, Column& to) { std::memcpy(&to, from, sizeof to); }

void subtractProducts(PaddedBlock* row, const PaddedBlock* lower, const int* at, int count,
                      const PaddedBlock& block) {
  for (int p = 0; p < count; ++p) {
    const double* l = lower[p].of;
    Column first, second, third;
    load(l, first);
    load(l + 4, second);
    load(l + 8, third);
    double* const to = row[at[p]].of;
    for (int j = 0; j < 3; ++j) {
      const double* b = block.of + 4 * j;
      Column sum;
      load(to + 4 * j, sum);
      sum -= first * b[0] + second * b[1] + third * b[2];
      std::memcpy(to + 4 * j, &sum, sizeof sum);
    }
  }
}

}  // namespace

const SubtractProducts KERNEL = subtractProducts;

}  // namespace physics
