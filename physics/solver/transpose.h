// Rows of single precision that lie in memory one after the other into columns. Included by the
// kernels alone.
#pragma once

#include <immintrin.h>

namespace physics {
namespace {

// r[i][k] <-> r[k][i]
inline void transpose(__m128 (&r)[4]) { _MM_TRANSPOSE4_PS(r[0], r[1], r[2], r[3]); }

#ifdef __AVX__
inline void transpose(__m256 (&r)[8]) {
  const __m256 a = _mm256_unpacklo_ps(r[0], r[1]), b = _mm256_unpackhi_ps(r[0], r[1]);
  const __m256 c = _mm256_unpacklo_ps(r[2], r[3]), d = _mm256_unpackhi_ps(r[2], r[3]);
  const __m256 e = _mm256_unpacklo_ps(r[4], r[5]), f = _mm256_unpackhi_ps(r[4], r[5]);
  const __m256 g = _mm256_unpacklo_ps(r[6], r[7]), h = _mm256_unpackhi_ps(r[6], r[7]);
  const __m256 ac = _mm256_shuffle_ps(a, c, 0x44), ca = _mm256_shuffle_ps(a, c, 0xEE);
  const __m256 bd = _mm256_shuffle_ps(b, d, 0x44), db = _mm256_shuffle_ps(b, d, 0xEE);
  const __m256 eg = _mm256_shuffle_ps(e, g, 0x44), ge = _mm256_shuffle_ps(e, g, 0xEE);
  const __m256 fh = _mm256_shuffle_ps(f, h, 0x44), hf = _mm256_shuffle_ps(f, h, 0xEE);
  r[0] = _mm256_permute2f128_ps(ac, eg, 0x20), r[1] = _mm256_permute2f128_ps(ca, ge, 0x20);
  r[2] = _mm256_permute2f128_ps(bd, fh, 0x20), r[3] = _mm256_permute2f128_ps(db, hf, 0x20);
  r[4] = _mm256_permute2f128_ps(ac, eg, 0x31), r[5] = _mm256_permute2f128_ps(ca, ge, 0x31);
  r[6] = _mm256_permute2f128_ps(bd, fh, 0x31), r[7] = _mm256_permute2f128_ps(db, hf, 0x31);
}
#endif

}  // namespace
}  // namespace physics
