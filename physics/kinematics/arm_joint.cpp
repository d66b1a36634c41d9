// Ball joints and hinges.
#include "physics/kinematics/arm_joint.h"

#include <Eigen/LU>
#include <algorithm>

#include "physics/base/rotation.h"

namespace physics {
namespace {

constexpr double kAtLimit = 1e-9;  // rad

// From the direction of the parent to that of the link, parent's frame. The first link is measured
// from its direction at zero.
AngleBetween bendOf(const Arm& arm, int k, const ArmJoint& joint) {
  const Vec3& straight = arm.links[k == 0 ? 0 : k - 1].direction;
  return angleBetween(straight, joint.turn * arm.links[k].direction);
}

// Inverse of a symmetric matrix that has one direction without inertia at the most: thin links in a
// straight line, which nothing twists, for their s x n has no part along it.
Mat3 inverseOf(const Mat3& inertia) {
  const double size = inertia.trace();
  if (inertia.determinant() > 1e-12 * size * size * size) return inertia.inverse();
  return (inertia + 1e-9 * size * Mat3::Identity()).inverse();
}

}  // namespace

void turnJoint(const Arm& arm, const ArmPosture& posture, int k, const Vec3& turn,
               ArmJoint& joint) {
  const ArmLink& link = arm.links[k];
  const Vec3 local = parentOf(arm, posture, k).conjugate() * turn;
  if (link.hinge) {
    joint.angle += link.axis.dot(local);
    joint.turn = exponential(joint.angle * link.axis);
  } else {
    joint.turn = (exponential(local) * joint.turn).normalized();
  }
}

Mat3 mobility(const Arm& arm, const ArmPosture& posture, int k, const Mat3& inertia) {
  if (!arm.links[k].hinge) return inverseOf(inertia);
  const Vec3 w = parentOf(arm, posture, k) * arm.links[k].axis;
  const double resistance = w.dot(inertia * w);
  // Nothing beyond stands off the axis: nothing to be gained by turning about it.
  if (!(resistance > 1e-12 * inertia.trace())) return Mat3::Zero();
  return w * w.transpose() / resistance;
}

bool holdAtLimit(const Arm& arm, const ArmPosture& posture, int k, const Vec3& turn, Mat3& p) {
  const ArmLink& link = arm.links[k];
  const ArmJoint& joint = arm.joints[k];
  const Quat& parent = parentOf(arm, posture, k);
  if (link.hinge) {
    const double change = (parent * link.axis).dot(turn);
    const bool further = (change > 0 && joint.angle >= link.range[1] - kAtLimit) ||
                         (change < 0 && joint.angle <= link.range[0] + kAtLimit);
    if (further) p.setZero();
    return further;
  }
  if (link.bend >= kPi) return false;
  const AngleBetween bend = bendOf(arm, k, joint);
  if (bend.phi < link.bend - kAtLimit) return false;
  const Vec3 b = parent * bend.w;  // turning about it bends further
  const Vec3 pb = p * b;
  if (turn.dot(b) <= 0 || b.dot(pb) <= 0) return false;
  p -= pb * pb.transpose() / b.dot(pb);  // now b . P torque = 0, whatever the torque
  return true;
}

bool clampToLimit(const Arm& arm, int k, ArmJoint& joint) {
  const ArmLink& link = arm.links[k];
  if (link.hinge) {
    const double angle = std::clamp(joint.angle, link.range[0], link.range[1]);
    if (angle == joint.angle) return false;
    joint.angle = angle;
    joint.turn = exponential(angle * link.axis);
    return true;
  }
  if (link.bend >= kPi) return false;
  const AngleBetween bend = bendOf(arm, k, joint);
  if (bend.phi <= link.bend + 1e-15) return false;
  joint.turn = (exponential((link.bend - bend.phi) * bend.w) * joint.turn).normalized();
  return true;
}

}  // namespace physics
