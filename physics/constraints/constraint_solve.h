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

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "physics/constraints/constraint_response.h"

namespace physics {

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

// The part of an error that is wrong: all of an equality's, the violated side of a bound's.
template <int B, int R>
typename Row<B, R>::Vector wrongPart(const Row<B, R>& row, const typename Row<B, R>::Vector& c) {
  if (row.high <= 0) return c.cwiseMax(0);
  if (row.low >= 0) return c.cwiseMin(0);
  return c;
}

template <class C>
VectorOf<C> standingError(const Evaluated<C>& row) {
  if constexpr (Force<C>) {
    return VectorOf<C>::Zero();
  } else {
    return wrongPart(row, row.c);
  }
}

// The new total of a constraint whose error is c, before its bounds.
template <int R>
Eigen::Matrix<double, R, 1> solved(Form form, double alpha, const Eigen::Matrix<double, R, R>& a,
                                   const Tuned& tuned, const Eigen::Matrix<double, R, 1>& c,
                                   const Eigen::Matrix<double, R, 1>& total) {
  const double extra = tuned.regularisation * a.trace() / R;  // (54)
  const Eigen::Matrix<double, R, 1> residual = c + (alpha + (tuned.damps ? 0 : extra)) * total;
  return total + step<R>(a, alpha + extra, tuned.relaxation, form, residual);
}

// The new total of a force: (1 + K A) dlambda = xi (f h^2 - lambda), (106),(118),(124).
template <int R>
Eigen::Matrix<double, R, 1> pushed(const Eigen::Matrix<double, R, 1>& f,
                                   const Eigen::Matrix<double, R, R>& k, double longest,
                                   const Eigen::Matrix<double, R, R>& a, double xi,
                                   const Eigen::Matrix<double, R, 1>& total) {
  const Eigen::Matrix<double, R, R> left = Eigen::Matrix<double, R, R>::Identity() + k * a;
  Eigen::Matrix<double, R, 1> next = total + xi * (left.inverse() * (f - total));
  constexpr double kFree = std::numeric_limits<double>::infinity();
  clampTotal(next, -kFree, kFree, longest);
  return next;
}

// The rest of a visit to what has been evaluated, a Row or a Push.
template <int B, int R, class RowOrPush>
bool solveEvaluated(const RowShape<B, R>& shape, Totals<R>& lambda, const Tuned& tuned,
                    Bodies& bodies, RowAndResponse<RowOrPush, ResponseOf<B, R>>& s) {
  if (!s.row.active) return true;
  const auto a = effectiveMassInverse(shape, s.row, bodies.inverse, s.response);
  if (!(a.trace() > 0)) return a.trace() == a.trace();  // nothing here can move
  Eigen::Matrix<double, R, 1> next;
  if constexpr (std::is_same_v<RowOrPush, Push<B, R>>) {
    next = pushed<R>(s.row.f, s.row.k, s.row.longest, a, tuned.relaxation, lambda.total);
  } else {
    next = solved<R>(shape.form, s.row.alpha, a, tuned, s.row.c, lambda.total);
    clampTotal(next, s.row.low, s.row.high, s.row.longest);
  }
  if (!next.allFinite()) return false;
  const Eigen::Matrix<double, R, 1> change = next - lambda.total;
  lambda.total = next;
  displaceBodies(shape, s.response, change, bodies);
  countTwist(shape, s.row, change, bodies);
  return true;
}

// One visit, (52),(53). False: the change was not finite.
template <class C>
bool solve(const C& item, Multipliers<C>& lambda, const Tuned& tuned, Bodies& bodies,
           const Configuration& at, Scratch<C>& s) {
  item.evaluate(at, s.row);
  return solveEvaluated(shapeOf(item), lambda, tuned, bodies, s);
}

// The same where the bodies may step by several schemes.
template <class C>
bool solve(const C& item, Multipliers<C>& lambda, const Tuned& tuned, Bodies& bodies, double dt,
           Scratch<C>& s) {
  return solve(item, lambda, tuned, bodies, configurationOf(item, bodies, dt), s);
}

}  // namespace physics
