// Two bodies, or a few, outside a World: what the solver sees, for tests of one constraint.
#pragma once

#include "physics/constraints/constraint_solve.h"
#include "physics/constraints/kinds.h"
#include "physics/make/matter.h"
#include "physics/motion/free_motion.h"

namespace physics::testing {

constexpr double kDegree = kPi / 180;

struct BodyOf {
  double mass = 1;              // kg; 0: immovable
  Vec3 inertia = Vec3::Ones();  // kg m^2; zeros: a point
  Pose pose;
};

inline Pose at(const Vec3& x) { return {x, Quat::Identity()}; }

// Adds a body at rest; its pose is the start of the substep too.
BodyId add(Bodies& bodies, const BodyOf& def);

Bodies bodiesOf(std::initializer_list<BodyOf> defs);

// Bodies with random masses and inertias (the triangle rule holds) near the origin.
Bodies randomBodies(Random& random, int count);
inline Bodies randomPair(Random& random) { return randomBodies(random, 2); }

Quat about(const Vec3& axis, double angle);  // angle [rad]

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // times the substep; about the origin
  double linearScale = 0, angularScale = 0;            // sums of the magnitudes they are made of
};
// What a solve that moved `before` to `after` gave the bodies.
Momenta given(const Bodies& before, const Bodies& after);

inline Tuned plain() { return {1, 0}; }

// One visit to the constraint, inertia as it stands.
template <class C>
bool visit(const C& item, Multipliers<C>& lambda, Bodies& bodies, double dt = 1.0 / 60) {
  Scratch<C> scratch;
  return solve(item, lambda, plain(), bodies, dt, scratch);
}

// Visits as a World with this constraint alone makes them: fresh inertia for each.
template <class C>
Multipliers<C> iterate(const C& item, Bodies& bodies, int visits, double dt = 1.0 / 60) {
  Multipliers<C> lambda;
  for (int k = 0; k < visits; ++k) {
    refreshInertia(bodies);
    visit(item, lambda, bodies, dt);
  }
  return lambda;
}

template <class C>
Evaluated<C> rowOf(const C& item, const Bodies& bodies, double dt = 1.0 / 60) {
  Evaluated<C> row;
  if constexpr (C::kBodies == kMany) {
    row.linear.resize(item.bodies.size());
    row.angular.resize(item.bodies.size());
  }
  for (auto& block : row.linear) block.setZero();
  for (auto& block : row.angular) block.setZero();
  item.evaluate({bodies.pose, bodies.start, dt}, row);
  return row;
}

// What is left to solve: c + alpha lambda of a constraint, lambda - f h^2 of a force.
template <class C>
double residualOf(const C& item, const Multipliers<C>& lambda, const Bodies& bodies) {
  const auto row = rowOf(item, bodies);
  if constexpr (Force<C>) {
    return (lambda.total - row.f).norm();
  } else {
    return (row.c + row.alpha * lambda.total).norm();
  }
}

// Of the kinds there are these are compiled in trial.cpp, once.
// clang-format off
#define DBD_EVERY_KIND(f)                                                               \
  f(Spring) f(VectorSpring) f(HardeningSpring) f(PointGravity) f(ConstantForce) f(Drag) \
  f(PanelDrag) f(Bend) f(Drive) f(MotorTorque) f(Motor) f(Volume) f(RopeLength) f(Link) \
  f(Distance) f(ConeLimit) f(TwistLimit) f(SlideLimit) f(Axle) f(Perpendicular)         \
  f(OrientationLock) f(PointOnLine) f(BallSocket)
#define DBD_VISITS(keyword, C)                                             \
  keyword template bool visit(const C&, Multipliers<C>&, Bodies&, double); \
  keyword template Multipliers<C> iterate(const C&, Bodies&, int, double); \
  keyword template Evaluated<C> rowOf(const C&, const Bodies&, double);
#define DBD_VISITS_ELSEWHERE(C) DBD_VISITS(extern, C)
// clang-format on
DBD_EVERY_KIND(DBD_VISITS_ELSEWHERE)

// The angle between two vectors [rad], by the C library.
double angleOf(const Vec3& a, const Vec3& b);

}  // namespace physics::testing
