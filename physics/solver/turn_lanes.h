// Turns of bodies in lanes, for the kernels alone.
#pragma once

#include "physics/solver/joint_numbers.h"

namespace physics {
namespace {

constexpr double kFarTurn2 = 1e-2;  // rad^2: below, five terms are exact to 1e-17

// exp(theta) as w, x, y, z.                                                                     (1)
template <class N>
void exponential(const Triple<N>& theta, N (&e)[4]) {
  const N one = all<N>(1), t = all<N>(0.25) * squaredNorm(theta);
  const auto series = [&](double a, double b, double c, double d) {
    return one -
           t * all<N>(a) * (one - t * all<N>(b) * (one - t * all<N>(c) * (one - t * all<N>(d))));
  };
  e[0] = one - t * all<N>(0.5) * series(1.0 / 12, 1.0 / 30, 1.0 / 56, 1.0 / 90);
  const N halfSinc = all<N>(0.5) * series(1.0 / 6, 1.0 / 20, 1.0 / 42, 1.0 / 72);
  const Triple<N> v = theta * halfSinc;
  e[1] = v.x, e[2] = v.y, e[3] = v.z;
  Num<N::kWidth> squared, parts[4], angles[3];
  store(squared, t + t + t + t);
  bool anyFar = false;
  for (int l = 0; l < N::kWidth; ++l) anyFar = anyFar || !(squared.v[l] < kFarTurn2);
  if (!anyFar) return;
  for (int k = 0; k < 4; ++k) store(parts[k], e[k]);
  store3(angles, theta);
  for (int l = 0; l < N::kWidth; ++l) {
    if (squared.v[l] < kFarTurn2) continue;
    double q[4];
    turnFar({angles[0].v[l], angles[1].v[l], angles[2].v[l]}, q);
    for (int k = 0; k < 4; ++k) parts[k].v[l] = q[k];
  }
  for (int k = 0; k < 4; ++k) e[k] = load(parts[k]);
}

// The turn e after that of q.
template <class N>
void turnFurther(const N (&e)[4], const N (&q)[4], N (&to)[4]) {
  to[0] = e[0] * q[0] - e[1] * q[1] - e[2] * q[2] - e[3] * q[3];
  to[1] = e[0] * q[1] + e[1] * q[0] + e[2] * q[3] - e[3] * q[2];
  to[2] = e[0] * q[2] + e[2] * q[0] + e[3] * q[1] - e[1] * q[3];
  to[3] = e[0] * q[3] + e[3] * q[0] + e[1] * q[2] - e[2] * q[1];
}

}  // namespace
}  // namespace physics
