// A constraint is its error c(X), its gradient and its bounds; the solver is one.
// What is solved, and how, is constraint_solve.h.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "physics/body.h"
#include "physics/fields.h"
#include "physics/rotation.h"

namespace physics {

// What a constraint may look at: the present displaced poses X^{t+1} + dX, the poses at the start
// of the substep, and its length [s].
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
  std::array<Gradient, kBodies> linear;  // dc/dx, only where the kind is linear
  std::array<Gradient, kBodies>
      angular;         // dc/dtheta; theta is a world-frame rotation, q <- exp(theta) q
  double alpha = 0;    // compliance, in units of A
  bool active = true;  // false: nothing to solve, whatever c
  double low = -std::numeric_limits<double>::infinity();  // bounds of every component of the total
  double high = std::numeric_limits<double>::infinity();
  double longest = std::numeric_limits<double>::infinity();  // bound of the total's length
};

template <class C>
struct Multipliers {
  using Vector = typename Row<C::kBodies, C::kRows>::Vector;
  Vector total = Vector::Zero();     // accumulated, of the motion; the next substep's first guess
  Vector once = Vector::Zero();      // accumulated, of the error that stood at X^t
  Vector standing = Vector::Zero();  // that error
};

// The constraints of one kind, in the order they were added.
template <class C>
struct Set {
  using Vector = typename Row<C::kBodies, C::kRows>::Vector;
  struct Tuned {
    double relaxation, regularisation;
    bool split;
  };
  std::vector<C> items;
  std::vector<Multipliers<C>> lambda;
  std::vector<Tuned> tuned;
};

// Springs, drives and motors are forces: they have no error that could stand.
template <class C>
constexpr bool isForce() {
  return requires { C::kForce; };
}

// Equalities without bounds: the rows that the direct method takes.
template <class C>
bool isEquality(const C& item) {
  if constexpr (requires { item.isEquality(); }) return item.isEquality();
  return false;
}

template <class C>
Form formOf(const C& item) {
  if constexpr (requires { item.form; }) return item.form;
  return Form::kVector;
}

}  // namespace physics
