// Eight single precision numbers at a time: one AVX2 register, or two SSE2 halves; or eight each of
// two blocks, an AVX-512 register. Every operation is rounded as IEEE says, lane by lane, so that
// all give the same bytes: no fused multiply-add, no approximate reciprocal. Included by the
// kernels alone, which are compiled once for each.
#pragma once

#include <immintrin.h>

#ifdef __AVX512F__
#include "physics/solver/lanes_of_two.h"
#else
#include "physics/solver/transpose.h"
#endif

namespace physics {
namespace {

#ifdef __AVX512F__
// Those of lanes_of_two.h.
#elif defined(__AVX2__)

struct Lanes {
  __m256 v;
};
inline Lanes operator+(Lanes a, Lanes b) { return {_mm256_add_ps(a.v, b.v)}; }
inline Lanes operator-(Lanes a, Lanes b) { return {_mm256_sub_ps(a.v, b.v)}; }
inline Lanes operator*(Lanes a, Lanes b) { return {_mm256_mul_ps(a.v, b.v)}; }
inline Lanes operator/(Lanes a, Lanes b) { return {_mm256_div_ps(a.v, b.v)}; }
inline Lanes larger(Lanes a, Lanes b) { return {_mm256_max_ps(a.v, b.v)}; }
inline Lanes smaller(Lanes a, Lanes b) { return {_mm256_min_ps(a.v, b.v)}; }
inline Lanes root(Lanes a) { return {_mm256_sqrt_ps(a.v)}; }
inline Lanes all(float a) { return {_mm256_set1_ps(a)}; }
inline Lanes load(const float* p) { return {_mm256_load_ps(p)}; }
inline void store(float* p, Lanes a) { _mm256_store_ps(p, a.v); }
// a where test > 0, else b.
inline Lanes wherePositive(Lanes test, Lanes a, Lanes b) {
  return {_mm256_blendv_ps(b.v, a.v, _mm256_cmp_ps(test.v, _mm256_setzero_ps(), _CMP_GT_OQ))};
}
// The lanes that are > 0, a bit each.
inline unsigned positive(Lanes a) {
  return static_cast<unsigned>(
      _mm256_movemask_ps(_mm256_cmp_ps(a.v, _mm256_setzero_ps(), _CMP_GT_OQ)));
}
inline void transpose(Lanes* r) {
  __m256 rows[8];
  for (int l = 0; l < 8; ++l) rows[l] = r[l].v;
  transpose(rows);
  for (int l = 0; l < 8; ++l) r[l].v = rows[l];
}

#else

struct Lanes {
  __m128 low, high;
};
inline Lanes operator+(Lanes a, Lanes b) {
  return {_mm_add_ps(a.low, b.low), _mm_add_ps(a.high, b.high)};
}
inline Lanes operator-(Lanes a, Lanes b) {
  return {_mm_sub_ps(a.low, b.low), _mm_sub_ps(a.high, b.high)};
}
inline Lanes operator*(Lanes a, Lanes b) {
  return {_mm_mul_ps(a.low, b.low), _mm_mul_ps(a.high, b.high)};
}
inline Lanes operator/(Lanes a, Lanes b) {
  return {_mm_div_ps(a.low, b.low), _mm_div_ps(a.high, b.high)};
}
inline Lanes larger(Lanes a, Lanes b) {
  return {_mm_max_ps(a.low, b.low), _mm_max_ps(a.high, b.high)};
}
inline Lanes smaller(Lanes a, Lanes b) {
  return {_mm_min_ps(a.low, b.low), _mm_min_ps(a.high, b.high)};
}
inline Lanes root(Lanes a) { return {_mm_sqrt_ps(a.low), _mm_sqrt_ps(a.high)}; }
inline Lanes all(float a) { return {_mm_set1_ps(a), _mm_set1_ps(a)}; }
inline Lanes load(const float* p) { return {_mm_load_ps(p), _mm_load_ps(p + 4)}; }
inline void store(float* p, Lanes a) {
  _mm_store_ps(p, a.low);
  _mm_store_ps(p + 4, a.high);
}
inline __m128 wherePositive(__m128 test, __m128 a, __m128 b) {
  const __m128 mask = _mm_cmpgt_ps(test, _mm_setzero_ps());
  return _mm_or_ps(_mm_and_ps(mask, a), _mm_andnot_ps(mask, b));
}
inline Lanes wherePositive(Lanes test, Lanes a, Lanes b) {
  return {wherePositive(test.low, a.low, b.low), wherePositive(test.high, a.high, b.high)};
}
inline unsigned positive(Lanes a) {
  const __m128 zero = _mm_setzero_ps();
  const int low = _mm_movemask_ps(_mm_cmpgt_ps(a.low, zero));
  return static_cast<unsigned>(low | _mm_movemask_ps(_mm_cmpgt_ps(a.high, zero)) << 4);
}
inline void transpose(Lanes* r) {
  for (int i = 0; i < 8; i += 4) {
    __m128 low[4], high[4];
    for (int l = 0; l < 4; ++l) low[l] = r[i + l].low, high[l] = r[i + l].high;
    transpose(low);
    transpose(high);
    for (int l = 0; l < 4; ++l) r[i + l].low = low[l], r[i + l].high = high[l];
  }
  for (int i = 0; i < 4; ++i) {
    const __m128 kept = r[i].high;
    r[i].high = r[i + 4].low;
    r[i + 4].low = kept;
  }
}

#endif

#ifndef __AVX512F__

// Of the blocks at work, those with a lane that is > 0: what is left undone where there is none is
// to leave no trace in the others, not in the sign of a zero.
struct Blocks {
  bool some;
  bool any() const { return some; }
};
inline Blocks blocksWith(Lanes test) { return {positive(test) != 0}; }
// a of those blocks, else b.
inline Lanes in(Blocks blocks, Lanes a, Lanes b) { return blocks.some ? a : b; }

// Row l of eight, where `slot` says, and back where `which` has its bit.
template <class Record>
inline Lanes loadAt(const int (&slot)[8], int l, const Record* records, float (Record::*row)[3]) {
  return load(records[slot[l]].*row);
}
template <class Record>
inline void storeAt(const int (&slot)[8], unsigned which, const Lanes (&rows)[8], Record* records,
                    float (Record::*row)[3]) {
  if (which == 0xFF) {
    for (int l = 0; l < 8; ++l) store(records[slot[l]].*row, rows[l]);
    return;
  }
  for (int l = 0; l < 8; ++l) {
    if (which >> l & 1) store(records[slot[l]].*row, rows[l]);
  }
}

#endif

struct Lanes3 {
  Lanes x, y, z;
};
inline Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Lanes3 operator*(const Lanes3& a, Lanes s) { return {a.x * s, a.y * s, a.z * s}; }
inline Lanes dot(const Lanes3& a, const Lanes3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Lanes3 in(Blocks blocks, const Lanes3& a, const Lanes3& b) {
  return {in(blocks, a.x, b.x), in(blocks, a.y, b.y), in(blocks, a.z, b.z)};
}
inline Lanes3 load(const float (&p)[3][8]) { return {load(p[0]), load(p[1]), load(p[2])}; }
inline void store(float (&p)[3][8], const Lanes3& a) {
  store(p[0], a.x);
  store(p[1], a.y);
  store(p[2], a.z);
}

}  // namespace
}  // namespace physics
