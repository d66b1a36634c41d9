// The generic solve of one constraint.
//
//   A = J M^-1 J^T,  alpha = row.alpha + epsilon tr(A)/rows
//   lambda <- clamp(lambda - xi (A + alpha)^-1 (c + alpha lambda)),  dX += M^-1 J^T (change of
//   lambda)
//
// which is (52) with relaxation (53) and regularisation (56),(59) in the corrected signs of
// paper.md, the total multiplier clamped and the difference applied. lambda is the multiplier times
// h^2.
#pragma once

#include <cmath>

#include "physics/constraint.h"
#include "physics/rotation.h"

namespace physics {

template <class C>
struct Response {  // M^-1 J^T, per body
  std::array<Eigen::Matrix<double, 3, C::kRows>, C::kBodies> linear, angular;
};

template <class C>
Eigen::Matrix<double, C::kRows, C::kRows> resistance(const C& item,
                                                     const Row<C::kBodies, C::kRows>& row,
                                                     std::span<const InverseMass> inverse,
                                                     Response<C>& response) {
  Eigen::Matrix<double, C::kRows, C::kRows> a;
  a.setZero();
  for (int b = 0; b < C::kBodies; ++b) {
    const InverseMass& mass = inverse[item.bodies[b]];
    if constexpr (C::kLinear) {
      response.linear[b] = mass.m * row.linear[b].transpose();
      a.noalias() += row.linear[b].lazyProduct(response.linear[b]);
    }
    response.angular[b].noalias() = mass.inertia.lazyProduct(row.angular[b].transpose());
    a.noalias() += row.angular[b].lazyProduct(response.angular[b]);
  }
  return a;
}

template <class C>
void displaceBodies(const C& item, const Response<C>& response, const typename Set<C>::Vector& once,
                    const typename Set<C>::Vector& lasting, Bodies& bodies) {
  const bool corrects = !once.isZero(0);
  if (!corrects && lasting.isZero(0)) return;
  for (int b = 0; b < C::kBodies; ++b) {
    const BodyId id = item.bodies[b];
    Vec3 dx = Vec3::Zero(), turn = response.angular[b].lazyProduct(lasting);
    if constexpr (C::kLinear) dx = response.linear[b].lazyProduct(lasting);
    bodies.shift[id] += dx;
    if (corrects) {
      Vec3 dxOnce = Vec3::Zero();
      if constexpr (C::kLinear) dxOnce = response.linear[b].lazyProduct(once);
      const Vec3 turnOnce = response.angular[b].lazyProduct(once);
      bodies.correction[id].dx += dxOnce;
      bodies.correction[id].dtheta += turnOnce;
      dx += dxOnce;
      turn += turnOnce;
    }
    displace(bodies.pose[id], dx, turn);
  }
}

template <class Vector>
void clampTotal(Vector& total, double low, double high, double longest) {
  total = total.cwiseMax(low).cwiseMin(high);
  if (std::isfinite(longest)) {
    const double length = total.norm();
    if (length > longest)
      total *= longest / length;  // (132) by length, then the difference is applied
  }
}

// -xi (A + alpha)^-1 residual; in the scalar form only along the residual, (63),(67).
template <int R>
Eigen::Matrix<double, R, 1> step(Eigen::Matrix<double, R, R> a, double alpha, double xi, Form form,
                                 const Eigen::Matrix<double, R, 1>& residual) {
  if constexpr (R == 1) {
    return -xi * residual / (a(0, 0) + alpha);
  } else {
    if (form == Form::kScalar) {
      const double squared = residual.squaredNorm();
      if (squared == 0) return Eigen::Matrix<double, R, 1>::Zero();
      return -xi * residual * (squared / (residual.dot(a * residual) + alpha * squared));
    }
    a.diagonal().array() += alpha;
    return -xi * (a.inverse() * residual);
  }
}

// J dX of a correction.
template <class C>
typename Set<C>::Vector along(const C& item, const Row<C::kBodies, C::kRows>& row,
                              std::span<const Correction> correction) {
  typename Set<C>::Vector sum = Set<C>::Vector::Zero();
  for (int b = 0; b < C::kBodies; ++b) {
    const Correction& moved = correction[item.bodies[b]];
    if constexpr (C::kLinear) sum += row.linear[b].lazyProduct(moved.dx);
    sum += row.angular[b].lazyProduct(moved.dtheta);
  }
  return sum;
}

// The part of an error at X^t that is wrong: all of an equality's, the violated side of a bound's.
template <class C>
typename Set<C>::Vector standingError(const Row<C::kBodies, C::kRows>& row) {
  if (row.high <= 0) return row.c.cwiseMax(0);
  if (row.low >= 0) return row.c.cwiseMin(0);
  return row.c;
}

// Splits a visit's error into what the motion of this substep made (solved by `total`, which lasts)
// and what stood at its start (solved by `once`, which is forgotten, and moves bodies without
// speeding them).
template <class C>
bool solve(const C& item, Multipliers<C>& lambda, const typename Set<C>::Tuned& tuned,
           Bodies& bodies, double dt) {
  Row<C::kBodies, C::kRows> row;
  item.evaluate({bodies.pose, bodies.start, dt}, row);
  if (!row.active) return true;
  Response<C> response;
  const auto a = resistance(item, row, bodies.inverse, response);
  const double mean = a.trace() / C::kRows;
  if (!(mean > 1e-300)) return mean == mean;  // nothing here can move
  const double alpha = row.alpha + tuned.regularisation * mean;
  using Vector = typename Set<C>::Vector;
  const auto change = [&](const Vector& c, const Vector& total) -> Vector {
    const Vector residual = c + alpha * total;
    Vector next = total + step<C::kRows>(a, alpha, tuned.relaxation, formOf(item), residual);
    clampTotal(next, row.low, row.high, row.longest);
    return next - total;
  };
  Vector once = Vector::Zero();
  if (tuned.split) {
    const Vector standing = lambda.standing + along(item, row, bodies.correction);
    once = change(standing, lambda.once);
    row.c -= standing;
  }
  const Vector lasting = change(row.c, lambda.total);
  if (!once.allFinite() || !lasting.allFinite()) return false;
  lambda.once += once;
  lambda.total += lasting;
  displaceBodies(item, response, once, lasting, bodies);
  return true;
}

// Start of a substep: what stands wrong at X^t, and the last multipliers as a first guess.
template <class C>
void prepare(const C& item, Multipliers<C>& lambda, bool warm, bool split, Bodies& bodies,
             double dt) {
  lambda.once.setZero();
  if (!warm) lambda.total.setZero();
  if (!split && lambda.total.isZero(0)) return;
  Row<C::kBodies, C::kRows> row;
  item.evaluate({bodies.start, bodies.start, dt}, row);
  lambda.standing = standingError<C>(row);
  if (lambda.total.isZero(0)) return;
  Response<C> response;
  resistance(item, row, bodies.inverse, response);
  displaceBodies(item, response, Set<C>::Vector::Zero(), lambda.total, bodies);
}

}  // namespace physics
