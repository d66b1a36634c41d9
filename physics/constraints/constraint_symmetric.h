// The visit of one constraint by the symmetric scheme (RATTLE), and the projection of velocities
// at its end. NOTES 6
//   constraint  c at the end of the step, J at its start: x += M^-1 J_n^T (change of lambda)
//   force       at the middle of the step, which is backward Euler over h/2 from its start: the
//               implicit midpoint rule. Half of its impulse moves the bodies, half is a last kick.
#pragma once

#include "physics/constraints/constraint_solve.h"

namespace physics {

inline Pose middleOf(const Pose& from, const Pose& to) {
  return {0.5 * (from.x + to.x), exponential(0.5 * logarithm(to.q * from.q.conjugate())) * from.q};
}

template <class C>
bool pushSymmetric(const C& item, Multipliers<C>& lambda, const Tuned& tuned, Bodies& bodies,
                   Scratch<C>& s) {
  SecondOrder& second = bodies.second;
  for (const BodyId body : item.bodies) {
    second.middle[body] = middleOf(bodies.start[body], bodies.pose[body]);
  }
  item.evaluate({second.middle, bodies.start, 0.5 * second.h, {}, {}, bodies.pose}, s.row);
  if (!s.row.active) return true;
  const auto a = effectiveMassInverse(item, s.row, bodies.inverse, s.response);
  if (!(a.trace() > 1e-300)) return a.trace() == a.trace();
  using Vector = VectorOf<C>;
  const Vector change = pushed<C>(s.row, a, tuned.relaxation, lambda.total) - lambda.total;
  if (!change.allFinite()) return false;
  lambda.step = 0.5 * second.h;
  lambda.total += change;  // force times (h/2)^2; it moves the bodies by h^2/2
  displaceBodies(item, s.response, (2 * change).eval(), bodies);
  countTwist(item, s.row, (2 * change).eval(), bodies);
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    DeltaX& kick = second.kick[item.bodies[b]];
    if (hasLinear(item)) kick.dx += 2 * s.response.linear[b].lazyProduct(change);
    if (hasAngular(item)) kick.dtheta += 2 * (s.row.angular[b].transpose() * change);
  }
  return true;
}

template <class C>
bool solveSymmetric(const C& item, Multipliers<C>& lambda, const Tuned& tuned, Bodies& bodies,
                    Scratch<C>& s) {
  if constexpr (Force<C>) {
    return pushSymmetric(item, lambda, tuned, bodies, s);
  } else {
    const double dt = stepOf(item, bodies, 0);
    item.evaluate({bodies.pose, bodies.start, dt}, s.row);
    if (!s.row.active) return true;
    const VectorOf<C> c = s.row.c;
    item.evaluate({bodies.start, bodies.start, dt}, s.row);  // its J
    const auto a = effectiveMassInverse(item, s.row, bodies.inverse, s.response);
    if (!(a.trace() > 1e-300)) return a.trace() == a.trace();
    const VectorOf<C> change = solved(item, s.row, a, tuned, c, lambda.total) - lambda.total;
    if (!change.allFinite()) return false;
    lambda.total += change;
    displaceBodies(item, s.response, change, bodies);
    countTwist(item, s.row, change, bodies);
    return true;
  }
}

// v += M^-1 J^T mu with J v = 0. Returns the change of J v [m/s, rad/s].
template <class C>
double projectVelocity(const C& item, Bodies& bodies, Scratch<C>& s) {
  item.evaluate({bodies.pose, bodies.start, stepOf(item, bodies, 0)}, s.row);
  constexpr double kFree = std::numeric_limits<double>::infinity();
  if (!s.row.active || s.row.low != -kFree || s.row.high != kFree) return 0;  // a limit at rest
  auto a = effectiveMassInverse(item, s.row, bodies.inverse, s.response);
  if (!(a.trace() > 1e-300)) return 0;
  a.diagonal().array() += 1e-12 * a.trace();  // 1e4 roundings: regular where its rows repeat
  VectorOf<C> rate = VectorOf<C>::Zero();
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const Velocity& velocity = bodies.velocity[item.bodies[b]];
    if (hasLinear(item)) rate += s.row.linear[b] * velocity.v;
    if (hasAngular(item)) rate += s.row.angular[b] * velocity.w;
  }
  const VectorOf<C> mu = -(a.inverse() * rate);
  for (std::size_t b = 0; b < item.bodies.size(); ++b) {
    const DeltaX change = displacementOf(item, s.response, b, mu);
    bodies.velocity[item.bodies[b]].v += change.dx;
    bodies.velocity[item.bodies[b]].w += change.dtheta;
  }
  return rate.norm();
}

}  // namespace physics
