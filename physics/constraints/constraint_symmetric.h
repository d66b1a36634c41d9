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

// A force that was evaluated in the middle.
template <int B, int R>
bool pushSymmetric(const RowShape<B, R>& shape, Totals<R>& lambda, const Tuned& tuned,
                   Bodies& bodies, RowAndResponse<Push<B, R>, ResponseOf<B, R>>& s) {
  if (!s.row.active) return true;
  SecondOrder& second = bodies.second;
  const auto a = effectiveMassInverse(shape, s.row, bodies.inverse, s.response);
  if (!(a.trace() > 1e-300)) return a.trace() == a.trace();
  using Vector = Eigen::Matrix<double, R, 1>;
  const Vector change =
      pushed<R>(s.row.f, s.row.k, s.row.longest, a, tuned.relaxation, lambda.total) - lambda.total;
  if (!change.allFinite()) return false;
  lambda.step = 0.5 * second.h;
  lambda.total += change;  // force times (h/2)^2; it moves the bodies by h^2/2
  const Vector moving = 2 * change;
  displaceBodies(shape, s.response, moving, bodies);
  countTwist(shape, s.row, moving, bodies);
  for (std::size_t b = 0; b < shape.bodies.size(); ++b) {
    DeltaX& kick = second.kick[shape.bodies[b]];
    if (shape.isLinear) kick.dx += 2 * s.response.linear[b].lazyProduct(change);
    if (shape.isAngular) kick.dtheta += 2 * (s.row.angular[b].transpose() * change);
  }
  return true;
}

// A constraint whose error at the end is c, and whose J at the start was evaluated.
template <int B, int R>
bool correctSymmetric(const RowShape<B, R>& shape, const Eigen::Matrix<double, R, 1>& c,
                      Totals<R>& lambda, const Tuned& tuned, Bodies& bodies,
                      RowAndResponse<Row<B, R>, ResponseOf<B, R>>& s) {
  const auto a = effectiveMassInverse(shape, s.row, bodies.inverse, s.response);
  if (!(a.trace() > 1e-300)) return a.trace() == a.trace();
  using Vector = Eigen::Matrix<double, R, 1>;
  Vector next = solved<R>(shape.form, s.row.alpha, a, tuned, c, lambda.total);
  clampTotal(next, s.row.low, s.row.high, s.row.longest);
  const Vector change = next - lambda.total;
  if (!change.allFinite()) return false;
  lambda.total += change;
  displaceBodies(shape, s.response, change, bodies);
  countTwist(shape, s.row, change, bodies);
  return true;
}

template <class C>
bool solveSymmetric(const C& item, Multipliers<C>& lambda, const Tuned& tuned, Bodies& bodies,
                    Scratch<C>& s) {
  if constexpr (Force<C>) {
    SecondOrder& second = bodies.second;
    for (const BodyId body : item.bodies) {
      second.middle[body] = middleOf(bodies.start[body], bodies.pose[body]);
    }
    item.evaluate({second.middle, bodies.start, 0.5 * second.h, {}, {}, bodies.pose}, s.row);
    return pushSymmetric(shapeOf(item), lambda, tuned, bodies, s);
  } else {
    const double dt = stepOf(item, bodies, 0);
    item.evaluate({bodies.pose, bodies.start, dt}, s.row);
    if (!s.row.active) return true;
    const VectorOf<C> c = s.row.c;
    item.evaluate({bodies.start, bodies.start, dt}, s.row);  // its J
    return correctSymmetric(shapeOf(item), c, lambda, tuned, bodies, s);
  }
}

// v += M^-1 J^T mu with J v = 0, J evaluated. Returns the change of J v [m/s, rad/s].
template <int B, int R>
double projectEvaluated(const RowShape<B, R>& shape, Bodies& bodies,
                        RowAndResponse<Row<B, R>, ResponseOf<B, R>>& s) {
  constexpr double kFree = std::numeric_limits<double>::infinity();
  if (!s.row.active || s.row.low != -kFree || s.row.high != kFree) return 0;  // a limit at rest
  auto a = effectiveMassInverse(shape, s.row, bodies.inverse, s.response);
  if (!(a.trace() > 1e-300)) return 0;
  a.diagonal().array() += 1e-12 * a.trace();  // 1e4 roundings: regular where its rows repeat
  Eigen::Matrix<double, R, 1> rate = Eigen::Matrix<double, R, 1>::Zero();
  for (std::size_t b = 0; b < shape.bodies.size(); ++b) {
    const Velocity& velocity = bodies.velocity[shape.bodies[b]];
    if (shape.isLinear) rate += s.row.linear[b] * velocity.v;
    if (shape.isAngular) rate += s.row.angular[b] * velocity.w;
  }
  const Eigen::Matrix<double, R, 1> mu = -(a.inverse() * rate);
  for (std::size_t b = 0; b < shape.bodies.size(); ++b) {
    const DeltaX change = displacementOf(shape, s.response, b, mu);
    bodies.velocity[shape.bodies[b]].v += change.dx;
    bodies.velocity[shape.bodies[b]].w += change.dtheta;
  }
  return rate.norm();
}

template <class C>
double projectVelocity(const C& item, Bodies& bodies, Scratch<C>& s) {
  item.evaluate({bodies.pose, bodies.start, stepOf(item, bodies, 0)}, s.row);
  return projectEvaluated(shapeOf(item), bodies, s);
}

}  // namespace physics
