// What the rivals share.
#include "physics/rivals/rival.h"

#include <Eigen/LU>

#include "physics/motion/restitution.h"

namespace physics {
namespace {

// One Newton step from the old rate on I (w' - w) + h w' x I w' = 0, body frame.
Vec3 implicitGyroscopic(const Vec3& inertia, const Vec3& omega, double dt) {
  const Vec3 momentum = inertia.cwiseProduct(omega);
  Mat3 jacobian = dt * (skew(omega) * inertia.asDiagonal().toDenseMatrix() - skew(momentum));
  jacobian.diagonal() += inertia;
  return omega - jacobian.inverse() * (dt * omega.cross(momentum));
}

void turnFaster(Bodies& bodies, int i, const Vec3& torque, double dt, Gyroscopic form) {
  const Mat3 rotation = bodies.pose[i].q.toRotationMatrix();
  const Vec3 &inertia = bodies.inertia[i], &inverse = bodies.inverseInertia[i];
  Vec3 omega = rotation.transpose() * bodies.velocity[i].w;
  const Vec3 gyroscopic = omega.cross(inertia.cwiseProduct(omega));
  const Vec3 gain = dt * inverse.cwiseProduct(rotation.transpose() * torque);
  const bool isRegular = inertia.minCoeff() > 0;
  if (form == Gyroscopic::kExplicit || !isRegular) {
    omega += gain - dt * inverse.cwiseProduct(gyroscopic);
  } else {
    omega = implicitGyroscopic(inertia, omega + gain, dt);
  }
  bodies.velocity[i].w = rotation * omega;
}

// Speeds of approach are those that the substep's own acceleration leads to, as restitution wants
// them.
void measureContacts(RivalModel& world, double dt) {
  Bodies& bodies = world.bodies;
  world.velocityBefore = bodies.velocity;
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies.motion[i] != Motion::kDynamic) continue;
    const Vec3 gravity = world.settings.gravity.value_or(Vec3::Zero());
    world.velocityBefore[i].v += dt * (gravity + bodies.inverse[i].m * world.loads[i].force);
  }
  std::swap(bodies.velocity, world.velocityBefore);
  for (ContactPair& pair : world.contacts.pairs) measureStart(pair, bodies);
  std::swap(bodies.velocity, world.velocityBefore);
}

}  // namespace

bool isRival(Method method) {
  return method == Method::kXpbd || method == Method::kSequentialImpulses ||
         method == Method::kPenalty || method == Method::kPenaltyExplicit;
}

void coast(RivalModel& world, double dt) {
  Bodies& bodies = world.bodies;
  bodies.start = bodies.pose;
  const Vec3 fall =
      world.settings.gravity ? Vec3(dt * dt * *world.settings.gravity) : Vec3::Zero().eval();
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies.motion[i] == Motion::kStatic) continue;
    displace(bodies.pose[i], dt * bodies.velocity[i].v, dt * bodies.velocity[i].w);
    if (bodies.motion[i] == Motion::kDynamic) bodies.pose[i].x += fall;
  }
}

void rivalSubstep(RivalModel& world, double dt, StepReport& report) {
  world.bodies.pose = world.bodies.start;
  refreshInertia(world.bodies);
  if (world.settings.method == Method::kXpbd) {  // its own restitution: speeds before the substep
    for (ContactPair& pair : world.contacts.pairs) measureStart(pair, world.bodies);
  } else {
    measureContacts(world, dt);
  }
  switch (world.settings.method) {
    case Method::kXpbd:
      return xpbd(world, dt, report);
    case Method::kSequentialImpulses:
      return sequentialImpulses(world, dt, report);
    case Method::kPenalty:
      return penalty(world, dt, report);
    case Method::kPenaltyExplicit:
      return penaltyExplicit(world, dt, report);
    default:
      return;
  }
}

void accelerate(RivalModel& world, double dt, Gyroscopic form) {
  Bodies& bodies = world.bodies;
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies.motion[i] != Motion::kDynamic) continue;
    const Load& load = world.loads[i];
    if (world.settings.gravity) bodies.velocity[i].v += dt * *world.settings.gravity;
    bodies.velocity[i].v += dt * bodies.inverse[i].m * load.force;
    if (!bodies.inverseInertia[i].isZero(0)) turnFaster(bodies, i, load.torque, dt, form);
  }
}

void advance(Bodies& bodies, double dt) {
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies.motion[i] == Motion::kStatic) continue;
    bodies.pose[i].x = bodies.start[i].x + dt * bodies.velocity[i].v;
    if (bodies.velocity[i].w.isZero(0)) continue;
    bodies.pose[i].q = (exponential(dt * bodies.velocity[i].w) * bodies.start[i].q).normalized();
  }
}

void bounce(RivalModel& world, double dt) {
  if (!world.settings.contact || world.bodies.mostRestitution == 0) return;
  restitute(world.contacts, world.bodies, world.flight(dt));
}

}  // namespace physics
