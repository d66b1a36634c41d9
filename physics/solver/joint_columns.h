// The columns of blocks of R rows, for the kernels of joint_block.h: of several lanes a number a
// row, of one lane the three rows in a register.
#pragma once

#include "physics/solver/joint_numbers.h"

namespace physics {
namespace {

template <int R, class N>
struct Column {
  N v[R];
};
template <int R, class N>
Column<R, N> loadColumn(const Num<N::kWidth>* p) {
  Column<R, N> column;
  for (int r = 0; r < R; ++r) column.v[r] = load(p[r]);
  return column;
}
template <int R, class N>
void storeColumn(Num<N::kWidth>* p, const Column<R, N>& column) {
  for (int r = 0; r < R; ++r) store(p[r], column.v[r]);
}
template <int R, class N>
Column<R, N> operator*(const Column<R, N>& a, N b) {
  Column<R, N> product;
  for (int r = 0; r < R; ++r) product.v[r] = a.v[r] * b;
  return product;
}
template <int R, class N>
Column<R, N> operator+(const Column<R, N>& a, const Column<R, N>& b) {
  Column<R, N> sum;
  for (int r = 0; r < R; ++r) sum.v[r] = a.v[r] + b.v[r];
  return sum;
}
template <int R, class N>
Column<R, N> operator-(const Column<R, N>& a, const Column<R, N>& b) {
  Column<R, N> difference;
  for (int r = 0; r < R; ++r) difference.v[r] = a.v[r] - b.v[r];
  return difference;
}

template <>
struct Column<3, One> {
  Four v;
};
template <>
inline Column<3, One> loadColumn<3, One>(const Num<1>* p) {
  return {loadThree(p->v)};
}
template <>
inline void storeColumn<3, One>(Num<1>* p, const Column<3, One>& column) {
  storeThree(p->v, column.v);
}
inline Column<3, One> operator*(const Column<3, One>& a, One b) { return {a.v * all<Four>(b.v)}; }
inline Column<3, One> operator+(const Column<3, One>& a, const Column<3, One>& b) {
  return {a.v + b.v};
}
inline Column<3, One> operator-(const Column<3, One>& a, const Column<3, One>& b) {
  return {a.v - b.v};
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
