// Rows of several constraints as the dense matrices of sections 3 and 4, for tests.
#pragma once

#include <Eigen/LU>
#include <span>

#include "tests/physics/pair.h"

namespace physics::testing {

struct Dense {
  Eigen::MatrixXd j, mass, inverseMass;  // M x 6N, 6N x 6N (21),(14)
  Eigen::VectorXd c;
  Eigen::MatrixXd a() const { return j * inverseMass * j.transpose(); }  // J M^-1 J^T
};

inline Mat3 inertiaOf(const Bodies& bodies, int b) {
  const Mat3 rotation = bodies.pose[b].q.toRotationMatrix();
  return rotation * bodies.inertia[b].asDiagonal() * rotation.transpose();
}

// Of bodies that all move; a point's rotation counts as one of unit inertia, which nothing turns.
template <class C>
Dense denseOf(std::span<const C> items, const Bodies& bodies, int firstBody = 0) {
  const int n = bodies.size() - firstBody, rows = C::kRows * static_cast<int>(items.size());
  Dense d{Eigen::MatrixXd::Zero(rows, 6 * n),
          Eigen::MatrixXd::Identity(6 * n, 6 * n),
          {},
          Eigen::VectorXd::Zero(rows)};
  for (int b = 0; b < n; ++b) {
    d.mass.block<3, 3>(6 * b, 6 * b) *= bodies.mass[firstBody + b];
    if (!bodies.inertia[firstBody + b].isZero(0)) {
      d.mass.block<3, 3>(6 * b + 3, 6 * b + 3) = inertiaOf(bodies, firstBody + b);
    }
  }
  d.inverseMass = d.mass.inverse();
  for (std::size_t k = 0; k < items.size(); ++k) {
    const auto row = rowOf(items[k], bodies);
    const int first = C::kRows * static_cast<int>(k);
    d.c.segment<C::kRows>(first) = row.c;
    for (std::size_t b = 0; b < items[k].bodies.size(); ++b) {
      const int at = 6 * (items[k].bodies[b] - firstBody);
      if constexpr (C::kLinear) d.j.block<C::kRows, 3>(first, at) = row.linear[b];
      const bool point = bodies.inertia[items[k].bodies[b]].isZero(0);
      if constexpr (isAngular<C>()) {
        if (!point) d.j.block<C::kRows, 3>(first, at + 3) = row.angular[b];
      }
    }
  }
  return d;
}

// The displacement from `before` to the bodies' poses, 6 numbers a body.
inline Eigen::VectorXd displacement(std::span<const Pose> before, std::span<const Pose> after) {
  Eigen::VectorXd dx(6 * before.size());
  for (std::size_t b = 0; b < before.size(); ++b) {
    dx.segment<3>(6 * b) = after[b].x - before[b].x;
    dx.segment<3>(6 * b + 3) = logarithm(after[b].q * before[b].q.conjugate());
  }
  return dx;
}

}  // namespace physics::testing
