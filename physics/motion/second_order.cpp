// Free motion and velocities of the second-order steppings.
#include "physics/motion/second_order.h"

#include "physics/base/rotation.h"

namespace physics {
namespace {

bool turnsByTorque(const Bodies& bodies, BodyId i) {
  return bodies.motion[i] == Motion::kDynamic && !bodies.inverseInertia[i].isZero(0);
}

double lengthOf(Scheme scheme, double h) {
  if (scheme == Scheme::kBdf2) return 2 * h / 3;
  // x = ... + h^2/2 a: as much displacement as backward Euler over h/sqrt(2)
  return scheme == Scheme::kSymmetric ? h / std::sqrt(2.0) : h;
}

// The turn over `dt` from orientation `from` with angular momentum L [world].
FreeTurn turnWith(const Bodies& bodies, BodyId i, const Quat& from, const Vec3& momentum, double dt,
                  double end) {
  const Vec3 inBody = from.conjugate() * momentum;
  const Vec3 omega = inBody.cwiseProduct(bodies.inverseInertia[i]);
  if (isIsotropic(bodies.inertia[i])) return {omega, omega, true};
  return freeTurn(bodies.inertia[i], omega, dt, end);
}

// q from target and twist; sets freeTurn to the turn that led there.
void balance(Bodies& bodies, BodyId i) {
  const SecondOrder& s = bodies.second;
  const bool isSymmetric = s.scheme[i] == Scheme::kSymmetric;
  const double dt = isSymmetric ? s.h : s.step[i];
  const Vec3 momentum = s.target[i] + (s.twist[i] + s.jointTwist[i]) / dt;
  const Quat from = bodies.start[i].q;
  const FreeTurn turn = turnWith(bodies, i, from, momentum, dt, isSymmetric ? 0.5 : 1);
  bodies.freeTurn[i] = dt * (from * turn.mean);
  bodies.pose[i].q = exponential(bodies.freeTurn[i]) * from;
}

void moveByBdf2(Bodies& bodies, BodyId i, const Load& load, const Vec3& gravity) {
  SecondOrder& s = bodies.second;
  const History& past = s.history[i];
  const double step = s.step[i];
  Velocity& velocity = bodies.velocity[i];
  bodies.start[i] = s.before[i] = s.origin[i];
  displace(bodies.start[i], past.dx / 3, past.dtheta / 3);
  displace(s.before[i], -past.dx, -past.dtheta);
  velocity.v =
      (4 * velocity.v - past.velocity) / 3 + step * (gravity + bodies.inverse[i].m * load.force);
  bodies.pose[i].x = bodies.start[i].x + step * velocity.v;
  if (!turnsByTorque(bodies, i)) return;
  s.target[i] = (4 * s.angularMomentum[i] - past.angularMomentum) / 3 + step * load.torque;
  balance(bodies, i);
  velocity.w = bodies.freeTurn[i] / step;
}

void moveSymmetrically(Bodies& bodies, BodyId i, const Load& load, const Vec3& gravity) {
  SecondOrder& s = bodies.second;
  Velocity& velocity = bodies.velocity[i];
  bodies.start[i] = s.origin[i];
  velocity.v += 0.5 * s.h * (gravity + bodies.inverse[i].m * load.force);
  bodies.pose[i].x = s.origin[i].x + s.h * velocity.v;
  if (!turnsByTorque(bodies, i)) return;
  s.target[i] = s.angularMomentum[i] + 0.5 * s.h * load.torque;
  balance(bodies, i);
  velocity.w = bodies.freeTurn[i] / s.h;
}

// Moved by its velocity, whatever the scheme; its virtual start gives it that velocity.
void moveKinematic(Bodies& bodies, BodyId i) {
  const SecondOrder& s = bodies.second;
  const Velocity& velocity = bodies.velocity[i];
  moveFreely(bodies, i, {}, {}, s.h);
  if (s.scheme[i] != Scheme::kBdf2) return;
  bodies.start[i] = bodies.pose[i];
  displace(bodies.start[i], -s.step[i] * velocity.v, -s.step[i] * velocity.w);
}

void begin(Bodies& bodies, BodyId i) {
  SecondOrder& s = bodies.second;
  s.step[i] = lengthOf(s.scheme[i], s.h);
  s.origin[i] = s.before[i] = bodies.pose[i];
  s.velocity[i] = bodies.velocity[i];
  s.twist[i].setZero();
  s.jointTwist[i].setZero();
  s.kick[i] = {};
  if (turnsByTorque(bodies, i)) {
    s.angularMomentum[i] = angularMomentum(bodies, i, bodies.velocity[i].w);
  }
  bodies.shift[i].setZero();
}

void finishBdf2(Bodies& bodies, BodyId i) {
  const double step = bodies.second.step[i];
  bodies.velocity[i].v += bodies.shift[i] / step;
  if (!turnsByTorque(bodies, i)) return;
  bodies.pose[i].q.normalize();
  const Quat turned = bodies.pose[i].q * bodies.start[i].q.conjugate();
  bodies.velocity[i].w = unwrapped(logarithm(turned), bodies.freeTurn[i]) / step;
}

void finishSymmetric(Bodies& bodies, BodyId i, const Load& load, const Vec3& gravity) {
  const SecondOrder& s = bodies.second;
  Velocity& velocity = bodies.velocity[i];
  velocity.v += 0.5 * s.h * (gravity + bodies.inverse[i].m * load.force) +
                (bodies.shift[i] + s.kick[i].dx) / s.h;
  if (!turnsByTorque(bodies, i)) return;
  bodies.pose[i].q.normalize();
  const Vec3 momentum = s.target[i] + 0.5 * s.h * load.torque +
                        (s.twist[i] + s.jointTwist[i] + s.kick[i].dtheta) / s.h;
  const Quat& q = bodies.pose[i].q;
  velocity.w = q * (q.conjugate() * momentum).cwiseProduct(bodies.inverseInertia[i]);
}

}  // namespace

void makeRoom(SecondOrder& s, std::span<const Pose> pose) {
  const std::size_t size = pose.size();
  s.scheme.resize(size, Scheme::kPaper);
  s.step.resize(size, 0);
  s.history.resize(size);
  s.origin.assign(pose.begin(), pose.end());
  s.before.assign(pose.begin(), pose.end());
  s.middle.resize(size);
  s.velocity.resize(size);
  for (std::vector<Vec3>* each : {&s.angularMomentum, &s.target, &s.twist, &s.jointTwist}) {
    each->resize(size, Vec3::Zero());
  }
  s.kick.resize(size);
}

Vec3 angularMomentum(const Bodies& bodies, BodyId i, const Vec3& w) {
  const Quat& q = bodies.pose[i].q;
  return q * bodies.inertia[i].cwiseProduct(q.conjugate() * w);
}

void moveFreelySecondOrder(Bodies& bodies, std::span<const Load> loads,
                           const std::optional<Vec3>& gravity, double h) {
  SecondOrder& s = bodies.second;
  s.h = h;
  const Vec3 g = gravity.value_or(Vec3::Zero());
  for (const BodyId i : bodies.active) {
    begin(bodies, i);
    if (bodies.motion[i] == Motion::kKinematic) {
      moveKinematic(bodies, i);
    } else if (bodies.motion[i] == Motion::kStatic || s.scheme[i] == Scheme::kPaper) {
      moveFreely(bodies, i, loads[i], gravity, h);
    } else if (s.scheme[i] == Scheme::kBdf2) {
      moveByBdf2(bodies, i, loads[i], g);
    } else {
      moveSymmetrically(bodies, i, loads[i], g);
    }
  }
}

void balance(Bodies& bodies) {
  balance(bodies, Scheme::kBdf2);
  balance(bodies, Scheme::kSymmetric);
}

void balance(Bodies& bodies, Scheme scheme) {
  const SecondOrder& s = bodies.second;
  if (s.empty()) return;
  for (const BodyId i : bodies.active) {
    if (s.scheme[i] != scheme || !turnsByTorque(bodies, i)) continue;
    if (s.twist[i].isZero(0) && s.jointTwist[i].isZero(0)) continue;
    balance(bodies, i);
  }
}

Vec3 missingTwist(const Bodies& bodies, BodyId i) {
  const SecondOrder& s = bodies.second;
  const Quat& q = bodies.pose[i].q;
  const Vec3 psi = unwrapped(logarithm(q * bodies.start[i].q.conjugate()), bodies.freeTurn[i]);
  const Vec3 has = q * bodies.inertia[i].cwiseProduct(q.conjugate() * psi);
  return s.step[i] * s.target[i] + s.twist[i] - has;
}

void finishSecondOrder(Bodies& bodies, std::span<const Load> loads,
                       const std::optional<Vec3>& gravity) {
  const SecondOrder& s = bodies.second;
  const Vec3 g = gravity.value_or(Vec3::Zero());
  for (const BodyId i : bodies.active) {
    if (bodies.motion[i] != Motion::kDynamic) continue;
    if (s.scheme[i] == Scheme::kPaper) finishVelocity(bodies, i, s.h);
    if (s.scheme[i] == Scheme::kBdf2) finishBdf2(bodies, i);
    if (s.scheme[i] == Scheme::kSymmetric) finishSymmetric(bodies, i, loads[i], g);
  }
}

void remember(Bodies& bodies, const std::vector<bool>& smooth) {
  SecondOrder& s = bodies.second;
  for (const BodyId i : bodies.active) {
    if (bodies.motion[i] != Motion::kDynamic) continue;
    History& past = s.history[i];
    past.smooth = smooth[i];
    past.dx = bodies.pose[i].x - s.origin[i].x;
    past.velocity = s.velocity[i].v;
    if (!turnsByTorque(bodies, i)) continue;
    past.dtheta = unwrapped(logarithm(bodies.pose[i].q * s.origin[i].q.conjugate()),
                            0.5 * s.h * (s.velocity[i].w + bodies.velocity[i].w));
    past.angularMomentum = s.angularMomentum[i];
  }
}

void forgetPast(SecondOrder& s, BodyId body) {
  if (!s.empty()) s.history[body].smooth = false;
}

void rewind(Bodies& bodies) {
  for (const BodyId i : bodies.active) {
    bodies.pose[i] = bodies.second.origin[i];
    bodies.velocity[i] = bodies.second.velocity[i];
  }
}

}  // namespace physics
