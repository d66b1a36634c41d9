// A constraint is its error c(X), its gradient and its bounds; the solver is one.
//
//   A = J M^-1 J^T,  alpha = row.alpha + epsilon tr(A)/rows
//   lambda <- clamp(lambda - xi (A + alpha)^-1 (c + alpha lambda)),  dX += M^-1 J^T (change of lambda)
//
// which is (52) with relaxation (53) and regularisation (56),(59) in the corrected signs of paper.md, the
// total multiplier clamped and the difference applied. lambda is the multiplier times h^2.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "physics/body.h"
#include "physics/fields.h"
#include "physics/rotation.h"

namespace physics {

// What a constraint may look at: the present displaced poses X^{t+1} + dX, the poses at the start of the
// substep, and its length [s].
struct Configuration {
  std::span<const Pose> now, start;
  double dt = 0;
};

// Error, gradient and bounds of one constraint at a configuration.
template <int kBodies, int kRows>
struct Row {
  using Vector = Eigen::Matrix<double, kRows, 1>;
  using Gradient = Eigen::Matrix<double, kRows, 3>;
  Vector c = Vector::Zero();
  std::array<Gradient, kBodies> linear;   // dc/dx, only where the kind is linear
  std::array<Gradient, kBodies> angular;  // dc/dtheta; theta is a world-frame rotation, q <- exp(theta) q
  double alpha = 0;                       // compliance, in units of A
  bool active = true;                     // false: nothing to solve, whatever c
  double low = -std::numeric_limits<double>::infinity();  // bounds of every component of the total
  double high = std::numeric_limits<double>::infinity();
  double longest = std::numeric_limits<double>::infinity();  // bound of the total's length
};

// The constraints of one kind, in the order they were added.
template <class C>
struct Set {
  using Vector = typename Row<C::kBodies, C::kRows>::Vector;
  struct Tuned {
    double relaxation, regularisation;
  };
  std::vector<C> items;
  std::vector<Vector> total;  // accumulated multipliers [unit of J M^-1 J^T inverse times c]
  std::vector<Tuned> tuned;
};

template <class C>
Form formOf(const C& item) {
  if constexpr (requires { item.form; }) return item.form;
  return Form::kVector;
}

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
void displaceBodies(const C& item, const Response<C>& response,
                    const typename Set<C>::Vector& change, Bodies& bodies) {
  for (int b = 0; b < C::kBodies; ++b) {
    const BodyId id = item.bodies[b];
    if constexpr (C::kLinear) {
      const Vec3 dx = response.linear[b].lazyProduct(change);
      bodies.pose[id].x += dx;
      bodies.shift[id] += dx;
    }
    const Vec3 turn = response.angular[b].lazyProduct(change);
    bodies.pose[id].q = exponential(turn) * bodies.pose[id].q;
  }
}

template <class Vector>
void clampTotal(Vector& total, double low, double high, double longest) {
  total = total.cwiseMax(low).cwiseMin(high);
  if (std::isfinite(longest)) {
    const double length = total.norm();
    if (length > longest) total *= longest / length;  // (132) by length, then the difference is applied
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

// One visit to one constraint. Returns false when the change is not finite (nothing is applied then).
template <class C>
bool solve(const C& item, typename Set<C>::Vector& total, const typename Set<C>::Tuned& tuned,
           Bodies& bodies, double dt) {
  Row<C::kBodies, C::kRows> row;
  item.evaluate({bodies.pose, bodies.start, dt}, row);
  if (!row.active) return true;
  Response<C> response;
  const auto a = resistance(item, row, bodies.inverse, response);
  const double mean = a.trace() / C::kRows;
  if (!(mean > 1e-300)) return mean == mean;  // nothing here can move
  const double alpha = row.alpha + tuned.regularisation * mean;
  const typename Set<C>::Vector residual = row.c + alpha * total;
  typename Set<C>::Vector next =
      total + step<C::kRows>(a, alpha, tuned.relaxation, formOf(item), residual);
  clampTotal(next, row.low, row.high, row.longest);
  const typename Set<C>::Vector change = next - total;
  if (!change.allFinite()) return false;
  total = next;
  if (change.isZero(0)) return true;
  displaceBodies(item, response, change, bodies);
  return true;
}

// Applies the multipliers that the last substep ended with, as a first guess of this one's.
template <class C>
void warmStart(const C& item, const typename Set<C>::Vector& total, Bodies& bodies, double dt) {
  if (total.isZero(0)) return;
  Row<C::kBodies, C::kRows> row;
  item.evaluate({bodies.pose, bodies.start, dt}, row);
  Response<C> response;
  resistance(item, row, bodies.inverse, response);
  displaceBodies(item, response, total, bodies);
}

}  // namespace physics
