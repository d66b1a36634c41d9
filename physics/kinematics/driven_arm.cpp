// Arms that move bodies.
#include "physics/kinematics/driven_arm.h"

#include "physics/base/rotation.h"

namespace physics {
namespace {

void follow(DrivenArm& driven, double dt) {
  const Vec3 apart = driven.target - driven.followed;
  const double most = driven.maxSpeed * dt, distance = apart.norm();
  driven.followed = distance <= most ? driven.target : driven.followed + most / distance * apart;
}

// False: it is there, or as near as can be.
bool solveOnce(DrivenArm& driven) {
  const ArmIteration done = iterate(driven.arm, driven.followed, driven.solve, driven.scratch);
  driven.held = done.held;
  if (!done.moved) return false;
  driven.effort += done.effort;
  ++driven.iterations;
  return true;
}

void solve(DrivenArm& driven) {
  driven.iterations = driven.held = 0;
  while (driven.iterations < driven.solve.iterations && solveOnce(driven)) {
  }
}

// Until the tip is as near as `tolerance` [m], or comes no nearer. The iteration is a steepest
// descent: the distance itself may grow from one to the next.
void solve(DrivenArm& driven, double tolerance) {
  constexpr int kPatience = 20;
  driven.iterations = driven.held = 0;
  double nearest = tipError(postureOf(driven.arm), driven.followed).c;
  for (int k = 0; nearest > tolerance && k < kPatience && solveOnce(driven); ++k) {
    const double error = tipError(postureOf(driven.arm), driven.followed).c;
    if (!(error < nearest)) continue;
    nearest = error;
    k = -1;
  }
}

double lengthOf(const Arm& arm) {
  double sum = 0;
  for (const ArmLink& link : arm.links) sum += link.length.norm();
  return sum;
}

void moveTo(const Pose& pose, BodyId body, Bodies& bodies, double dt) {
  Pose& now = bodies.pose[body];
  now.q.normalize();
  bodies.velocity[body].v = (pose.x - now.x) / dt;
  bodies.velocity[body].w = logarithm(pose.q * now.q.conjugate()) / dt;
}

}  // namespace

DrivenArm makeDriven(const ArmDef& def) {
  DrivenArm driven;
  driven.arm = makeArm(def);
  driven.solve = def.solve;
  driven.maxSpeed = def.maxSpeed;
  driven.start = driven.before.joints = driven.arm.joints;
  driven.followed = driven.before.followed = postureOf(driven.arm).tip;
  driven.target = def.target.value_or(driven.followed);
  return driven;
}

BodyDef linkBody(const ArmDef& def, const DrivenArm& driven, int k) {
  BodyDef body;
  body.shape = Capsule{def.links[k].radius, def.links[k].length.norm()};
  body.pose = linkPose(driven.arm, postureOf(driven.arm), k);
  body.motion = Motion::kKinematic;
  body.friction = def.friction;
  return body;
}

Pose linkPose(const Arm& arm, const ArmPosture& posture, int k) {
  const ArmLink& link = arm.links[k];
  return {posture.pivot[k] + posture.q[k] * (0.5 * link.length),
          (posture.q[k] * fromUp(link.direction)).normalized()};
}

void drive(std::vector<DrivenArm>& arms, Bodies& bodies, double dt,
           std::optional<double> accuracy) {
  for (DrivenArm& driven : arms) {
    driven.before.joints = driven.arm.joints;
    driven.before.followed = driven.followed;
    driven.before.effort = driven.effort;
    follow(driven, dt);
    if (accuracy) {
      solve(driven, *accuracy * lengthOf(driven.arm));
    } else {
      solve(driven);
    }
    place(driven.arm, driven.arm.joints, driven.scratch.now);
    for (int k = 0; k < driven.arm.size(); ++k) {
      moveTo(linkPose(driven.arm, driven.scratch.now, k), driven.bodies[k], bodies, dt);
    }
  }
}

void undo(std::vector<DrivenArm>& arms) {
  for (DrivenArm& driven : arms) {
    driven.arm.joints = driven.before.joints;
    driven.followed = driven.before.followed;
    driven.effort = driven.before.effort;
  }
}

ArmReport report(const DrivenArm& driven) {
  const Arm& arm = driven.arm;
  const ArmPosture posture = postureOf(arm);
  ArmReport out;
  out.bodies = driven.bodies;
  out.tip = posture.tip;
  out.target = driven.target;
  out.followed = driven.followed;
  out.error = tipError(posture, driven.target).c;
  out.pivots = posture.pivot;
  out.centres = posture.centre;
  pivotInertias(arm, posture, out.inertia);
  for (int k = 0; k < arm.size(); ++k) {
    out.toTip.push_back(posture.toTip(k));
    out.turns.push_back(turnBetween(arm.links[k], driven.before.joints[k], arm.joints[k]));
    out.turned.push_back(turnBetween(arm.links[k], driven.start[k], arm.joints[k]).norm());
  }
  out.effort = driven.effort;
  out.iterations = driven.iterations;
  out.held = driven.held;
  return out;
}

}  // namespace physics
