// The part of the joint kernels that solves for limits: what eliminating the other rows leaves of A
// for them, and which of them are at a bound.
#pragma once

#include "physics/solver/joint_factor.h"
#include "physics/solver/joint_limits.h"

namespace physics {
namespace {

// L and D^-1 of the rows that are free, 1 on the diagonal of the others.
template <class N>
void factorizeTail(const Of<N>& s) {
  const JointTail<N::kWidth>& tail = s.tail;
  const int n = *tail.count;
  for (int i = 0; i < n; ++i) {
    const N free = load(tail.free[i]);
    auto* row = tail.factor + triangle(i, 0);
    for (int j = 0; j < i; ++j) {
      const N both = wherePositive(free, load(tail.free[j]), all<N>(0));
      const N entry = load(tail.a[triangle(tail.places[i], tail.places[j])]);
      N sum = wherePositive(both, entry, all<N>(0));
      const auto* other = tail.factor + triangle(j, 0);
      for (int k = 0; k < j; ++k) sum = sum - load(row[k]) * load(other[k]);
      store(row[j], sum);  // L_ij D_j for now
    }
    N d = wherePositive(free, load(tail.a[triangle(tail.places[i], tail.places[i])]), all<N>(1));
    for (int j = 0; j < i; ++j) {
      const N scaled = load(row[j]), l = scaled * load(tail.factor[triangle(j, j)]);
      d = d - scaled * l;
      store(row[j], l);
    }
    store(row[i], all<N>(1) / d);
  }
}

// What the rows that were held give up, taken from what the others aim at; x = A^-1 of that.
template <class N>
void solveTailOnce(const Of<N>& s) {
  const JointTail<N::kWidth>& tail = s.tail;
  const int n = *tail.count;
  for (int i = 0; i < n; ++i) {
    N sum = load(s.rows[s.tailStart + tail.places[i]].right[0]);
    for (int j = 0; j < n; ++j) {
      if (!tail.gives[j]) continue;
      const int k = tail.places[i], l = tail.places[j];
      sum = sum - load(tail.a[k > l ? triangle(k, l) : triangle(l, k)]) * load(tail.held[j]);
    }
    sum = wherePositive(load(tail.free[i]), sum, all<N>(0));
    const auto* row = tail.factor + triangle(i, 0);
    for (int j = 0; j < i; ++j) sum = sum - load(row[j]) * load(tail.x[j]);
    store(tail.x[i], sum);
  }
  for (int i = 0; i < n; ++i) {
    store(tail.x[i], load(tail.x[i]) * load(tail.factor[triangle(i, i)]));
  }
  for (int i = n; i-- > 0;) {
    const N x = load(tail.x[i]);
    const auto* row = tail.factor + triangle(i, 0);
    for (int j = 0; j < i; ++j) store(tail.x[j], load(tail.x[j]) - load(row[j]) * x);
  }
}

// Limits that the solution would take past a bound are held there. False: there are none.
template <class N>
bool holdAtBounds(const Of<N>& s) {
  const JointTail<N::kWidth>& tail = s.tail;
  const N open = load(*s.open), zero = all<N>(0);
  bool any = false;
  for (int i = 0; i < *tail.count; ++i) {
    const auto& row = s.rows[s.tailStart + tail.places[i]];
    const N lambda = load(row.lambda[0]), wanted = lambda + load(tail.x[i]);
    const N inside = within<N>(row, wanted), free = load(tail.free[i]);
    const N holds = wherePositive(open, wherePositive(free, differ(inside, wanted), zero), zero);
    if (!anyPositive(holds)) continue;
    any = true;
    tail.gives[i] = 1;
    store(tail.held[i], wherePositive(holds, inside - lambda, load(tail.held[i])));
    store(tail.free[i], wherePositive(holds, zero, free));
  }
  return any;
}

// Each round holds one more in every lane that goes on, so that there are no more than there are
// rows.
template <class N>
void solveTail(const Of<N>& s) {
  const JointTail<N::kWidth>& tail = s.tail;
  bool isStale = !*tail.isFactored;
  for (int i = 0; i < *tail.count; ++i) {
    const N free = load(s.rows[s.tailStart + tail.places[i]].free);
    isStale = isStale || anyPositive(differ(free, load(tail.free[i])));
    store(tail.free[i], free);
    store(tail.held[i], all<N>(0));
    tail.gives[i] = 0;
  }
  for (;;) {
    if (isStale) factorizeTail<N>(s);
    solveTailOnce<N>(s);
    isStale = holdAtBounds<N>(s);
    if (!isStale) break;
  }
  *tail.isFactored = true;
  for (int i = 0; i < *tail.count; ++i) {
    const N free = load(tail.free[i]);
    store(s.rows[s.tailStart + tail.places[i]].right[0],
          wherePositive(free, load(tail.x[i]), load(tail.held[i])));
  }
}

}  // namespace
}  // namespace physics
