// Six numbers of single precision at the start of a record of eight, for each lane one, as lanes of
// double precision, and back. Included by the kernels alone.
#pragma once

#include "physics/solver/joint_numbers.h"
#include "physics/solver/transpose.h"

namespace physics {
namespace {

inline void loadSix(const float* const (&from)[1], One (&to)[6]) {
  for (int k = 0; k < 6; ++k) to[k].v = double(from[0][k]);
}
inline void storeSix(const One (&from)[6], float* const (&to)[1], int) {
  for (int k = 0; k < 6; ++k) to[0][k] = static_cast<float>(from[k].v);
}

#ifdef __AVX2__
inline Four widened(__m128 a) { return {_mm256_cvtps_pd(a)}; }
inline __m128 narrowed(Four a) { return _mm256_cvtpd_ps(a.v); }
#else
inline Four widened(__m128 a) { return {_mm_cvtps_pd(a), _mm_cvtps_pd(_mm_movehl_ps(a, a))}; }
inline __m128 narrowed(Four a) { return _mm_movelh_ps(_mm_cvtpd_ps(a.low), _mm_cvtpd_ps(a.high)); }
#endif

inline void loadSix(const float* const (&from)[4], Four (&to)[6]) {
  for (int half = 0; half < 2; ++half) {
    __m128 rows[4];
    for (int l = 0; l < 4; ++l) rows[l] = _mm_load_ps(from[l] + 4 * half);
    transpose(rows);
    for (int k = 4 * half; k < 6 && k < 4 * half + 4; ++k) to[k] = widened(rows[k - 4 * half]);
  }
}
// Of the first `count` lanes.
inline void storeSix(const Four (&from)[6], float* const (&to)[4], int count) {
  for (int half = 0; half < 2; ++half) {
    __m128 rows[4];
    for (int k = 0; k < 4; ++k) {
      rows[k] = 4 * half + k < 6 ? narrowed(from[4 * half + k]) : _mm_setzero_ps();
    }
    transpose(rows);
    for (int l = 0; l < count; ++l) _mm_store_ps(to[l] + 4 * half, rows[l]);
  }
}

#ifdef __AVX512F__
inline void loadSix(const float* const (&from)[8], Eight (&to)[6]) {
  __m256 rows[8];
  for (int l = 0; l < 8; ++l) rows[l] = _mm256_load_ps(from[l]);
  transpose(rows);
  for (int k = 0; k < 6; ++k) to[k].v = _mm512_maskz_cvtps_pd(kEvery, rows[k]);
}
inline void storeSix(const Eight (&from)[6], float* const (&to)[8], int count) {
  __m256 rows[8];
  for (int k = 0; k < 6; ++k) rows[k] = _mm512_maskz_cvtpd_ps(kEvery, from[k].v);
  rows[6] = rows[7] = _mm256_setzero_ps();
  transpose(rows);
  for (int l = 0; l < count; ++l) _mm256_store_ps(to[l], rows[l]);
}
#endif

}  // namespace
}  // namespace physics
