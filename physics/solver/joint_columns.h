// The columns of blocks of 1 or 3 rows, for the kernels of joint_block.h: of several lanes a number
// a row, of one lane three rows in a register.
#pragma once

#include "physics/solver/joint_numbers.h"

namespace physics {
namespace {

struct Three {
  Four v;
};
inline Three operator*(Three a, One b) { return {a.v * all<Four>(b.v)}; }
inline Three operator+(Three a, Three b) { return {a.v + b.v}; }
inline Three operator-(Three a, Three b) { return {a.v - b.v}; }

template <int R, class N>
struct ColumnOf {
  using Type = Triple<N>;
};
template <class N>
struct ColumnOf<1, N> {
  using Type = N;
};
template <>
struct ColumnOf<3, One> {
  using Type = Three;
};
template <int R, class N>
using Column = typename ColumnOf<R, N>::Type;

template <int R, class N>
Column<R, N> loadColumn(const Num<N::kWidth>* p) {
  if constexpr (R == 1) {
    return load(*p);
  } else if constexpr (N::kWidth == 1) {
    return {loadThree(p->v)};
  } else {
    return load3<N>(p);
  }
}

template <int R, class N>
void storeColumn(Num<N::kWidth>* p, const Column<R, N>& column) {
  if constexpr (R == 1) {
    store(*p, column);
  } else if constexpr (N::kWidth == 1) {
    storeThree(p->v, column.v);
  } else {
    store3(p, column);
  }
}

template <int R, class N>
void storeColumnWhere(N test, Num<N::kWidth>* p, const Column<R, N>& column) {
  if constexpr (R == 1) {
    storeWhere(test, *p, column);
  } else if constexpr (N::kWidth == 1) {
    if (test.v > 0) storeThree(p->v, column.v);
  } else {
    storeWhere3(test, p, column);
  }
}

// A column of A B: `a` by its columns, and of B's column the K numbers that lie kStep apart.
template <int R, int K, int kStep, class N>
Column<R, N> product(const Column<R, N> (&a)[K], const Num<N::kWidth>* b) {
  Column<R, N> sum = a[0] * load(b[0]);
  for (int k = 1; k < K; ++k) sum = sum + a[k] * load(b[k * kStep]);
  return sum;
}

}  // namespace
}  // namespace physics
