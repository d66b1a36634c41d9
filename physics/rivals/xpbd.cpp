// XPBD as published, to compare with: Macklin, Mueller, Chentanez, XPBD (2016); Macklin et al.,
// Small Steps in Physics Simulation (2019); Mueller et al., Detailed Rigid Body Simulation with
// Extended Position Based Dynamics (2020).
//   predict    v += h g, w += h I^-1 (tau - w x I w);  x += h v, q += h/2 (0, w) q
//   solve      dlambda = -(C + alpha/h^2 lambda)/(w_1 + w_2 + alpha/h^2) along C, lambda = 0 at
//   first velocities v = (x - x^t)/h, w = 2 Im(q q^t-1)/h contacts   dynamic friction and
//   restitution once more, on velocities
// A substep takes one iteration (`iterations` gives more); accuracy comes from substeps.
#include <cmath>

#include "physics/constraints/constraint_solve.h"
#include "physics/rivals/rival.h"

namespace physics {
namespace {

// q + 1/2 (0, theta) q, normalised: as published, where the rest of this project has exp(theta) q.
Quat turned(const Quat& q, const Vec3& theta) {
  Quat next = Quat(0, 0.5 * theta.x(), 0.5 * theta.y(), 0.5 * theta.z()) * q;
  next.coeffs() += q.coeffs();
  return next.normalized();
}

void predict(Bodies& bodies, double dt) {
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies.motion[i] == Motion::kStatic) continue;
    const Velocity& velocity = bodies.velocity[i];
    bodies.pose[i].x += dt * velocity.v;
    if (!velocity.w.isZero(0)) bodies.pose[i].q = turned(bodies.pose[i].q, dt * velocity.w);
  }
}

void forgetMultipliers(RivalModel& world) {
  forEachKind(world.kinds, [](auto& kind) {
    for (auto& lambda : kind.set.lambda) lambda = {};
  });
  for (ContactPair& pair : world.contacts.pairs) {
    for (ContactPointState& p : pair.points) {
      p.normalTotal = 0;
      p.frictionTotal.setZero();
    }
  }
}

// The new total of a constraint: a joint of several rows is corrected along its error, as one
// scalar constraint. A force is compliant through its K: with f = -k (c - l) - nu dc/dt, K = k h^2
// + nu h this is the damped constraint of XPBD (26), alpha = 1/k and gamma = nu/(h k).
template <class R>
VectorOf<R> nextTotal(const R& frozen) {
  const auto& row = frozen.row;
  const VectorOf<R>& total = *frozen.total;
  if constexpr (R::kIsForce) {
    return pushed<R::kRows>(row.f, row.k, row.longest, frozen.a, frozen.tuned.relaxation, total);
  } else {
    const double alpha = row.alpha + frozen.tuned.regularisation * frozen.a.trace() / R::kRows;
    const VectorOf<R> residual = row.c + alpha * total;
    VectorOf<R> next =
        total + step<R::kRows>(frozen.a, alpha, frozen.tuned.relaxation, Form::kScalar, residual);
    clampTotal(next, row.low, row.high, row.longest);
    return next;
  }
}

template <class R>
bool project(R& frozen, Bodies& bodies) {
  if (!frozen.row.active) return true;
  frozen.a = effectiveMassInverse(frozen, frozen.row, bodies.inverse, frozen.response);
  if (!(frozen.a.trace() > 1e-300)) return std::isfinite(frozen.a.trace());  // nothing can move
  const VectorOf<R> next = nextTotal(frozen);
  if (!next.allFinite()) return false;
  const VectorOf<R> change = next - *frozen.total;
  for (std::size_t b = 0; b < frozen.bodies.size(); ++b) {
    const DeltaX moved = displacementOf(shapeOf(frozen), frozen.response, b, change);
    Pose& pose = bodies.pose[frozen.bodies[b]];
    pose.x += moved.dx;
    if (frozen.isAngular) pose.q = turned(pose.q, moved.dtheta);
  }
  *frozen.total = next;
  return true;
}

void displace(const Touch& touch, const TouchRow& row, double change, Bodies& bodies) {
  for (int b = 0; b < touch.count; ++b) {
    Pose& pose = bodies.pose[touch.bodies[b]];
    pose.x += change * row.linear[b];
    if (!row.turn[b].isZero(0)) pose.q = turned(pose.q, change * row.turn[b]);
  }
}

// Normal, then static friction: it takes the whole slip back, or nothing where that would need more
// than nu_s lambda_n. Detailed Rigid Body Simulation, 3.5.
bool projectTouch(const Touch& touch, double& normal, Vec3& friction, Bodies& bodies) {
  Vec3 slip = touch.moved;
  if (touch.gap < 0) {
    const TouchRow row = rowOf(touch, touch.n, bodies.inverse);
    if (!(row.resistance > 1e-300)) return std::isfinite(row.resistance);
    const double change = -touch.gap / row.resistance;
    if (!std::isfinite(change)) return false;
    displace(touch, row, change, bodies);
    normal += change;
    for (int b = 0; b < touch.count; ++b) {
      slip += change * touch.weight[b] * (row.linear[b] + row.turn[b].cross(touch.arm[b]));
    }
  }
  if (normal == 0) return true;
  slip -= slip.dot(touch.n) * touch.n;
  const double size = slip.norm();
  if (size < 1e-14) return true;
  const TouchRow row = rowOf(touch, slip / size, bodies.inverse);
  const Vec3 next = friction - size / row.resistance * row.d;
  if (next.norm() > touch.friction.staticCoefficient * normal) return std::isfinite(size);
  displace(touch, row, -size / row.resistance, bodies);
  friction = next;
  return true;
}

void takeVelocities(Bodies& bodies, double dt) {
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies.motion[i] != Motion::kDynamic) continue;
    bodies.velocity[i].v = (bodies.pose[i].x - bodies.start[i].x) / dt;
    if (bodies.inverseInertia[i].isZero(0)) continue;
    const Quat turn = bodies.pose[i].q * bodies.start[i].q.conjugate();
    bodies.velocity[i].w = (turn.w() >= 0 ? 2 : -2) / dt * turn.vec();
  }
}

// Dynamic friction and the normal velocity at one contact that carries lambda_n, 3.6. The printed
// (30) compares h nu_d f_n, an impulse, with a velocity; here both are impulses. The approach is
// that of X^t, before gravity: with it a ball at rest height would bounce higher than it fell.
void solveVelocity(const Touch& touch, double normal, const ContactPointState* p, double dt,
                   double threshold, Bodies& bodies, Vec3& friction) {
  if (normal == 0) return;
  const Vec3 v = velocityOf(touch, bodies.velocity);
  const double restitution =
      std::max(bodies.restitution[touch.bodies[0]], bodies.restitution[touch.bodies[1]]);
  const double vn = v.dot(touch.n), e = std::abs(vn) <= threshold ? 0 : restitution;
  const Vec3 vt = v - vn * touch.n;
  const double speed = vt.norm();
  if (speed > 1e-14) {
    const TouchRow row = rowOf(touch, vt / speed, bodies.inverse);
    const double most = touch.friction.dynamicCoefficient * normal / dt;
    const double impulse = std::min(most, speed / row.resistance);
    push(touch, row, -impulse, bodies.velocity);
    friction -= dt * impulse * row.d;
  }
  const TouchRow row = rowOf(touch, touch.n, bodies.inverse);
  const double wanted = p == nullptr ? 0 : std::max(-e * p->approach, 0.0);
  push(touch, row, (wanted - vn) / row.resistance, bodies.velocity);
}

void solveVelocities(RivalModel& world, double dt, StepReport& report) {
  if (!world.settings.contact) return;
  report.constraintEvaluations += contactVisits(world);
  const double threshold = world.settings.gravity ? 2 * dt * world.settings.gravity->norm() : 0;
  forEachTouch(world, report,
               [&](const Touch& touch, double normal, Vec3& friction, const ContactPointState* p) {
                 solveVelocity(touch, normal, p, dt, threshold, world.bodies, friction);
                 return true;
               });
}

bool sweepOnce(RivalModel& world, double dt, StepReport& report) {
  bool finite = true;
  report.constraintEvaluations += contactVisits(world);
  const Configuration x{world.bodies.pose, world.bodies.start, dt};
  forEachList(world.kinds, world.frozen, [&](auto& rows, const KindPlace& kind) {
    rows.resize(1);  // to work in: each is evaluated where the one before has left its bodies
    for (std::size_t k = 0; k < kind.count && finite; ++k) {
      ++report.constraintEvaluations;
      evaluate(world.kinds, kind.place, k, x, rows[0]);
      finite = project(rows[0], world.bodies);
      if (!finite) nameCulprit(report, kind.word, k, moverOf(rows[0], world.bodies));
    }
  });
  return finite && forEachTouch(world, report,
                                [&](const Touch& touch, double& normal, Vec3& friction, auto*) {
                                  return projectTouch(touch, normal, friction, world.bodies);
                                });
}

}  // namespace

void xpbd(RivalModel& world, double dt, StepReport& report) {
  accelerate(world, dt, Gyroscopic::kExplicit);
  predict(world.bodies, dt);
  forgetMultipliers(world);
  for (int k = 0; k < world.settings.iterations; ++k) {
    refreshInertia(world.bodies);
    if (!sweepOnce(world, dt, report)) return;
    ++report.iterations;
  }
  takeVelocities(world.bodies, dt);
  refreshInertia(world.bodies);
  solveVelocities(world, dt, report);
}

}  // namespace physics
