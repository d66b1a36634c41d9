// One double, four at a time in one AVX2 register or two SSE2 halves, or eight in one of AVX-512.
// Every operation is rounded as IEEE says, lane by lane, so that all give the same bytes. Included
// by the kernels alone.
#pragma once

#include <immintrin.h>

#include "physics/solver/joint_block.h"

namespace physics {
namespace {

struct One {
  static constexpr int kWidth = 1;
  double v;
};
inline One operator+(One a, One b) { return {a.v + b.v}; }
inline One operator-(One a, One b) { return {a.v - b.v}; }
inline One operator*(One a, One b) { return {a.v * b.v}; }
inline One operator/(One a, One b) { return {a.v / b.v}; }
inline One larger(One a, One b) { return {a.v > b.v ? a.v : b.v}; }
inline One smaller(One a, One b) { return {a.v < b.v ? a.v : b.v}; }
inline One root(One a) { return {__builtin_sqrt(a.v)}; }
inline One wherePositive(One test, One a, One b) { return test.v > 0 ? a : b; }
inline bool anyPositive(One test) { return test.v > 0; }
inline void put(double a, One& to) { to.v = a; }
inline One load(const Num<1>& p) { return {p.v[0]}; }
inline void store(Num<1>& p, One a) { p.v[0] = a.v; }

#ifdef __AVX2__

struct Four {
  static constexpr int kWidth = 4;
  __m256d v;
};
inline Four operator+(Four a, Four b) { return {_mm256_add_pd(a.v, b.v)}; }
inline Four operator-(Four a, Four b) { return {_mm256_sub_pd(a.v, b.v)}; }
inline Four operator*(Four a, Four b) { return {_mm256_mul_pd(a.v, b.v)}; }
inline Four operator/(Four a, Four b) { return {_mm256_div_pd(a.v, b.v)}; }
inline Four larger(Four a, Four b) { return {_mm256_max_pd(a.v, b.v)}; }
inline Four smaller(Four a, Four b) { return {_mm256_min_pd(a.v, b.v)}; }
inline Four root(Four a) { return {_mm256_sqrt_pd(a.v)}; }
inline Four wherePositive(Four test, Four a, Four b) {
  return {_mm256_blendv_pd(b.v, a.v, _mm256_cmp_pd(test.v, _mm256_setzero_pd(), _CMP_GT_OQ))};
}
inline bool anyPositive(Four test) {
  return _mm256_movemask_pd(_mm256_cmp_pd(test.v, _mm256_setzero_pd(), _CMP_GT_OQ)) != 0;
}
inline void put(double a, Four& to) { to.v = _mm256_set1_pd(a); }
inline Four load(const Num<4>& p) { return {_mm256_load_pd(p.v)}; }
inline void store(Num<4>& p, Four a) { _mm256_store_pd(p.v, a.v); }
// Three that lie side by side anywhere; the fourth is none.
inline Four loadThree(const double* p) {
  return {_mm256_maskload_pd(p, _mm256_setr_epi64x(-1, -1, -1, 0))};
}
inline void storeThree(double* p, Four a) {
  _mm_storeu_pd(p, _mm256_castpd256_pd128(a.v));
  _mm_store_sd(p + 2, _mm256_extractf128_pd(a.v, 1));
}

#else

struct Four {
  static constexpr int kWidth = 4;
  __m128d low, high;
};
inline Four operator+(Four a, Four b) {
  return {_mm_add_pd(a.low, b.low), _mm_add_pd(a.high, b.high)};
}
inline Four operator-(Four a, Four b) {
  return {_mm_sub_pd(a.low, b.low), _mm_sub_pd(a.high, b.high)};
}
inline Four operator*(Four a, Four b) {
  return {_mm_mul_pd(a.low, b.low), _mm_mul_pd(a.high, b.high)};
}
inline Four operator/(Four a, Four b) {
  return {_mm_div_pd(a.low, b.low), _mm_div_pd(a.high, b.high)};
}
inline Four larger(Four a, Four b) {
  return {_mm_max_pd(a.low, b.low), _mm_max_pd(a.high, b.high)};
}
inline Four smaller(Four a, Four b) {
  return {_mm_min_pd(a.low, b.low), _mm_min_pd(a.high, b.high)};
}
inline Four root(Four a) { return {_mm_sqrt_pd(a.low), _mm_sqrt_pd(a.high)}; }
inline __m128d chosen(__m128d test, __m128d a, __m128d b) {
  const __m128d mask = _mm_cmpgt_pd(test, _mm_setzero_pd());
  return _mm_or_pd(_mm_and_pd(mask, a), _mm_andnot_pd(mask, b));
}
inline Four wherePositive(Four test, Four a, Four b) {
  return {chosen(test.low, a.low, b.low), chosen(test.high, a.high, b.high)};
}
inline bool anyPositive(Four test) {
  const __m128d zero = _mm_setzero_pd();
  return (_mm_movemask_pd(_mm_cmpgt_pd(test.low, zero)) |
          _mm_movemask_pd(_mm_cmpgt_pd(test.high, zero))) != 0;
}
inline void put(double a, Four& to) { to.low = to.high = _mm_set1_pd(a); }
inline Four load(const Num<4>& p) { return {_mm_load_pd(p.v), _mm_load_pd(p.v + 2)}; }
inline void store(Num<4>& p, Four a) {
  _mm_store_pd(p.v, a.low);
  _mm_store_pd(p.v + 2, a.high);
}
inline Four loadThree(const double* p) { return {_mm_loadu_pd(p), _mm_load_sd(p + 2)}; }
inline void storeThree(double* p, Four a) {
  _mm_storeu_pd(p, a.low);
  _mm_store_sd(p + 2, a.high);
}

#endif

#ifdef __AVX512F__

struct Eight {
  static constexpr int kWidth = 8;
  __m512d v;
};
inline Eight operator+(Eight a, Eight b) { return {_mm512_add_pd(a.v, b.v)}; }
inline Eight operator-(Eight a, Eight b) { return {_mm512_sub_pd(a.v, b.v)}; }
inline Eight operator*(Eight a, Eight b) { return {_mm512_mul_pd(a.v, b.v)}; }
inline Eight operator/(Eight a, Eight b) { return {_mm512_div_pd(a.v, b.v)}; }
// With a mask of all lanes: g++ 12 warns of what it leaves undefined without one.
constexpr __mmask8 kEvery = 0xff;
inline Eight larger(Eight a, Eight b) { return {_mm512_mask_max_pd(a.v, kEvery, a.v, b.v)}; }
inline Eight smaller(Eight a, Eight b) { return {_mm512_mask_min_pd(a.v, kEvery, a.v, b.v)}; }
inline Eight root(Eight a) { return {_mm512_mask_sqrt_pd(a.v, kEvery, a.v)}; }
inline __mmask8 positive(Eight a) {
  return _mm512_cmp_pd_mask(a.v, _mm512_setzero_pd(), _CMP_GT_OQ);
}
inline Eight wherePositive(Eight test, Eight a, Eight b) {
  return {_mm512_mask_blend_pd(positive(test), b.v, a.v)};
}
inline bool anyPositive(Eight test) { return positive(test) != 0; }
inline void put(double a, Eight& to) { to.v = _mm512_set1_pd(a); }
inline Eight load(const Num<8>& p) { return {_mm512_load_pd(p.v)}; }
inline void store(Num<8>& p, Eight a) { _mm512_store_pd(p.v, a.v); }

#endif

// Only in lanes where test > 0.
template <class N>
inline void storeWhere(N test, Num<N::kWidth>& to, N a) {
  store(to, wherePositive(test, a, load(to)));
}
#ifdef __AVX512F__
inline void storeWhere(Eight test, Num<8>& to, Eight a) {
  _mm512_mask_store_pd(to.v, positive(test), a.v);
}
#endif

template <class N>
inline N all(double a) {
  N to;
  put(a, to);
  return to;
}

template <class N>
struct Triple {
  N x, y, z;
};
template <class N>
inline Triple<N> operator+(const Triple<N>& a, const Triple<N>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class N>
inline Triple<N> operator-(const Triple<N>& a, const Triple<N>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class N>
inline Triple<N> operator*(const Triple<N>& a, N s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class N>
inline N dot(const Triple<N>& a, const Triple<N>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
inline Triple<N> cross(const Triple<N>& a, const Triple<N>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class N>
inline N squaredNorm(const Triple<N>& a) {
  return dot(a, a);
}
template <class N>
inline Triple<N> load3(const Num<N::kWidth>* p) {
  return {load(p[0]), load(p[1]), load(p[2])};
}
template <class N>
inline void store3(Num<N::kWidth>* p, const Triple<N>& a) {
  store(p[0], a.x);
  store(p[1], a.y);
  store(p[2], a.z);
}

template <class N>
inline void storeWhere3(N test, Num<N::kWidth>* p, const Triple<N>& a) {
  storeWhere(test, p[0], a.x);
  storeWhere(test, p[1], a.y);
  storeWhere(test, p[2], a.z);
}

// By lane: it is > 0.
template <class N>
inline void storePositive(N test, bool (&to)[N::kWidth]) {
  Num<N::kWidth> flags;
  store(flags, test);
  for (int l = 0; l < N::kWidth; ++l) to[l] = flags.v[l] > 0;
}

template <class N>
using Of = JointView<N::kWidth>;

}  // namespace
}  // namespace physics
