// Lanes of two contact blocks that lie behind each other, in an AVX-512 register: rows of eight are
// loaded from both, and stored to both. A part of lanes.h.
#pragma once

#include <immintrin.h>

#include "physics/solver/contact_block.h"

namespace physics {
namespace {

// From a number of one block to that of the next.
constexpr int kToNext = sizeof(ContactBlock) / sizeof(float);

struct Lanes {
  __m512 v;
};
inline Lanes operator+(Lanes a, Lanes b) { return {_mm512_add_ps(a.v, b.v)}; }
inline Lanes operator-(Lanes a, Lanes b) { return {_mm512_sub_ps(a.v, b.v)}; }
inline Lanes operator*(Lanes a, Lanes b) { return {_mm512_mul_ps(a.v, b.v)}; }
inline Lanes operator/(Lanes a, Lanes b) { return {_mm512_div_ps(a.v, b.v)}; }
// The forms with a mask: of the others headers of g++ 12 read what nobody has set.
constexpr __mmask16 kEach = 0xFFFF;
constexpr __mmask8 kEachPair = 0xFF;
inline Lanes larger(Lanes a, Lanes b) { return {_mm512_maskz_max_ps(kEach, a.v, b.v)}; }
inline Lanes smaller(Lanes a, Lanes b) { return {_mm512_maskz_min_ps(kEach, a.v, b.v)}; }
inline Lanes root(Lanes a) { return {_mm512_maskz_sqrt_ps(kEach, a.v)}; }
inline Lanes all(float a) { return {_mm512_set1_ps(a)}; }

inline Lanes both(const float* first, const float* second) {
  const __m512d low = _mm512_castpd256_pd512(_mm256_castps_pd(_mm256_load_ps(first)));
  const __m256d high = _mm256_castps_pd(_mm256_load_ps(second));
  return {_mm512_castpd_ps(_mm512_maskz_insertf64x4(kEachPair, low, high, 1))};
}
template <int kWhich>
inline __m256 of(Lanes a) {
  return _mm256_castpd_ps(_mm512_maskz_extractf64x4_pd(kEachPair, _mm512_castps_pd(a.v), kWhich));
}
inline Lanes load(const float* p) { return both(p, p + kToNext); }
inline void store(float* p, Lanes a) {
  _mm256_store_ps(p, of<0>(a));
  _mm256_store_ps(p + kToNext, of<1>(a));
}

inline __mmask16 positive(Lanes a) {
  return _mm512_cmp_ps_mask(a.v, _mm512_setzero_ps(), _CMP_GT_OQ);
}
inline Lanes wherePositive(Lanes test, Lanes a, Lanes b) {
  return {_mm512_mask_blend_ps(positive(test), b.v, a.v)};
}

struct Blocks {
  unsigned lanes;  // a bit each
  bool any() const { return lanes != 0; }
};
inline Blocks blocksWith(Lanes test) {
  const unsigned those = positive(test);
  return {((those & 0xFF) != 0 ? 0xFFu : 0u) | ((those >> 8) != 0 ? 0xFF00u : 0u)};
}
inline Lanes in(Blocks blocks, Lanes a, Lanes b) {
  return {_mm512_mask_blend_ps(static_cast<__mmask16>(blocks.lanes), b.v, a.v)};
}

// r[i][k] <-> r[k][i], in each of the two.
inline void transpose(Lanes* r) {
  const auto low = [](__m512 x, __m512 y) { return _mm512_maskz_unpacklo_ps(kEach, x, y); };
  const auto high = [](__m512 x, __m512 y) { return _mm512_maskz_unpackhi_ps(kEach, x, y); };
  const __m512 a = low(r[0].v, r[1].v), b = high(r[0].v, r[1].v);
  const __m512 c = low(r[2].v, r[3].v), d = high(r[2].v, r[3].v);
  const __m512 e = low(r[4].v, r[5].v), f = high(r[4].v, r[5].v);
  const __m512 g = low(r[6].v, r[7].v), h = high(r[6].v, r[7].v);
  const auto lows = [](__m512 x, __m512 y) { return _mm512_maskz_shuffle_ps(kEach, x, y, 0x44); };
  const auto highs = [](__m512 x, __m512 y) { return _mm512_maskz_shuffle_ps(kEach, x, y, 0xEE); };
  const __m512 ac = lows(a, c), ca = highs(a, c), bd = lows(b, d), db = highs(b, d);
  const __m512 eg = lows(e, g), ge = highs(e, g), fh = lows(f, h), hf = highs(f, h);
  const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  const auto pick = [](__m512 x, __m512i of, __m512 y) {
    return _mm512_castpd_ps(_mm512_permutex2var_pd(_mm512_castps_pd(x), of, _mm512_castps_pd(y)));
  };
  r[0].v = pick(ac, first, eg), r[1].v = pick(ca, first, ge);
  r[2].v = pick(bd, first, fh), r[3].v = pick(db, first, hf);
  r[4].v = pick(ac, second, eg), r[5].v = pick(ca, second, ge);
  r[6].v = pick(bd, second, fh), r[7].v = pick(db, second, hf);
}

template <class Record>
inline Lanes loadAt(const int (&slot)[8], int l, const Record* records, float (Record::*row)[3]) {
  return both(records[slot[l]].*row, records[(slot + kToNext)[l]].*row);
}
template <class Record>
inline void storeAt(const int (&slot)[8], unsigned which, const Lanes (&rows)[8], Record* records,
                    float (Record::*row)[3]) {
  const int* next = slot + kToNext;
  if (which == kEach) {
    for (int l = 0; l < 8; ++l) {
      _mm256_store_ps(records[slot[l]].*row, of<0>(rows[l]));
      _mm256_store_ps(records[next[l]].*row, of<1>(rows[l]));
    }
    return;
  }
  for (int l = 0; l < 8; ++l) {
    if (which >> l & 1) _mm256_store_ps(records[slot[l]].*row, of<0>(rows[l]));
    if (which >> (8 + l) & 1) _mm256_store_ps(records[next[l]].*row, of<1>(rows[l]));
  }
}

}  // namespace
}  // namespace physics
