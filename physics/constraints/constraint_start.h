// What a constraint's multipliers are at the start of a substep.
#pragma once

#include "physics/constraints/constraint_solve.h"

namespace physics {

// Multipliers are forces times the square of the step: to those of another step.
template <class C>
void rescale(Multipliers<C>& lambda, double step) {
  if (lambda.step > 0 && lambda.step != step) {
    lambda.total *= (step / lambda.step) * (step / lambda.step);
  }
  lambda.step = step;
}

// The rows at X^t.
template <class C>
void evaluateAtStart(const C& item, const Bodies& bodies, double dt, Evaluated<C>& row) {
  const std::vector<Pose>& start = bodies.second.empty() ? bodies.start : bodies.second.origin;
  item.evaluate({start, start, stepOf(item, bodies, dt)}, row);
}

// Start of a substep that takes back `most` [m, rad] of an error at X^t.
template <class C>
void leave(const C& item, Multipliers<C>& lambda, double most, const Bodies& bodies, double dt) {
  if constexpr (canStand<C>() && C::kBodies != kMany) {
    Row<C::kBodies, C::kRows> row;
    evaluateAtStart(item, bodies, dt, row);
    const typename Set<C>::Vector standing = standingError<C>(row);
    double error = standing.norm();
    if constexpr (requires { item.errorPerMetre(); }) error /= item.errorPerMetre();
    lambda.left = error > most ? (1 - most / error) * standing : 0 * standing;
  }
}

// Start of a substep: what stands wrong at X^t, and the last multipliers as a first guess.
template <class C>
void prepare(const C& item, Multipliers<C>& lambda, bool warm, bool split, Bodies& bodies,
             double dt) {
  lambda.once.setZero();
  lambda.loaded = !lambda.total.isZero(0);
  if (!warm) lambda.total.setZero();
  rescale(lambda, stepOf(item, bodies, dt));
  if (!split && lambda.total.isZero(0)) return;
  Scratch<C> s;  // of a kind with kMany bodies this allocates, and only where multipliers are kept
  evaluateAtStart(item, bodies, dt, s.row);
  lambda.standing = standingError<C>(s.row) - lambda.left;
  if (lambda.total.isZero(0)) return;
  effectiveMassInverse(item, s.row, bodies.inverse, s.response);
  displaceBodies(item, s.response, Set<C>::Vector::Zero(), lambda.total, bodies);
  countTwist(item, s.row, lambda.total, bodies);
}

}  // namespace physics
