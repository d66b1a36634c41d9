// Definition, forward kinematics and inertia of an arm.
#include "physics/kinematics/arm.h"

#include <cmath>

#include "physics/base/rotation.h"
#include "physics/kinematics/arm_joint.h"

namespace physics {
namespace {

void requireLink(bool condition, int k, const char* expectation) {
  if (condition) return;
  require(false, "link " + std::to_string(k) + ": expected " + expectation);
}

// A cylinder's moments, y along it.
Vec3 cylinderInertia(double mass, double radius, double length) {
  const double across = mass * (3 * radius * radius + length * length) / 12;
  return {across, 0.5 * mass * radius * radius, across};
}

void checkLink(const ArmLinkDef& def, int k) {
  requireLink(def.length.allFinite() && def.length.norm() > 1e-9, k, "a length > 0");
  requireLink(std::isfinite(def.mass) && def.mass > 0, k, "a mass > 0");
  requireLink(std::isfinite(def.radius) && def.radius > 0, k, "a radius > 0");
  requireLink(def.axis.allFinite() && def.axis.norm() > 1e-12, k, "an axis that is not zero");
  requireLink(std::isfinite(def.angle), k, "a finite angle");
  requireLink(def.range[0] <= def.range[1], k, "limits in order");
  requireLink(def.bend >= 0, k, "a largest bend >= 0");
  requireLink(!def.centre || def.centre->allFinite(), k, "a finite centre of mass");
  requireLink(!def.inertia || (def.inertia->allFinite() && def.inertia->minCoeff() >= 0), k,
              "moments of inertia >= 0");
  const Vec3 moments = def.inertia.value_or(Vec3::Zero());
  requireLink(2 * moments.maxCoeff() <= moments.sum() * (1 + 1e-9), k,
              "moments of inertia of which none exceeds the sum of the other two");
}

ArmLink makeLink(const ArmLinkDef& def) {
  ArmLink link;
  const double length = def.length.norm();
  link.length = def.length;
  link.direction = def.length / length;
  link.mass = def.mass;
  link.centre = def.centre.value_or(0.5 * def.length);
  const Mat3 frame = fromUp(link.direction).toRotationMatrix();
  const Vec3 moments = def.inertia.value_or(cylinderInertia(def.mass, def.radius, length));
  link.inertia = frame * moments.asDiagonal() * frame.transpose();
  link.hinge = def.hinge;
  link.axis = def.axis.normalized();
  link.range = def.range;
  link.bend = def.bend;
  return link;
}

// Without this the joint would turn by any angle for nothing.
bool resists(const ArmLink& link) {
  const Mat3 about = link.inertia + link.mass * skew(link.centre) * skew(link.centre).transpose();
  const double least = 1e-12 * link.mass * link.length.squaredNorm();
  if (link.hinge) return link.axis.dot(about * link.axis) > least;
  return about.trace() - link.direction.dot(about * link.direction) > least;
}

}  // namespace

Arm makeArm(const ArmDef& def) {
  require(!def.links.empty(), "expected at least one link");
  require(def.at.allFinite() && def.rotation.norm() > 1e-6, "an arm's base must be a finite pose");
  require(def.solve.iterations >= 0 && def.solve.relaxation > 0 && def.solve.relaxation < 2 &&
              def.solve.regularisation >= 0 && def.solve.maxTurn > 0 && def.maxSpeed > 0,
          "iterations and regularisation must be >= 0, relaxation between 0 and 2, the rest > 0");
  require(!def.target || def.target->allFinite(), "an arm's target must be finite");
  Arm arm{def.at, def.rotation.normalized(), {}, {}};
  for (const ArmLinkDef& item : def.links) {
    const int k = arm.size();
    checkLink(item, k);
    arm.links.push_back(makeLink(item));
    arm.joints.push_back({exponential(item.angle * arm.links[k].axis), item.angle});
    ArmJoint joint = arm.joints.back();
    const bool beyond = clampToLimit(arm, k, joint);
    requireLink(!beyond || turnBetween(arm.links[k], joint, arm.joints[k]).norm() < 1e-9, k,
                "a start within its limits");
    arm.joints[k] = joint;
  }
  requireLink(resists(arm.links.back()), arm.size() - 1,
              "some inertia about its joint: nothing comes after it");
  return arm;
}

void place(const Arm& arm, std::span<const ArmJoint> joints, ArmPosture& posture) {
  const std::size_t count = arm.links.size();
  posture.q.resize(count);
  posture.pivot.resize(count);
  posture.centre.resize(count);
  posture.tip = arm.root;
  for (std::size_t k = 0; k < count; ++k) {
    const Quat& parent = k == 0 ? arm.base : posture.q[k - 1];
    posture.q[k] = (parent * joints[k].turn).normalized();
    posture.pivot[k] = posture.tip;
    posture.centre[k] = posture.tip + posture.q[k] * arm.links[k].centre;
    posture.tip += posture.q[k] * arm.links[k].length;  // (149), from the root on
  }
}

ArmPosture postureOf(const Arm& arm) {
  ArmPosture posture;
  place(arm, arm.joints, posture);
  return posture;
}

void pivotInertias(const Arm& arm, const ArmPosture& posture, std::vector<Mat3>& inertia) {
  inertia.resize(arm.links.size());
  double mass = 0;                // of the links from k on, taken as one body:
  Vec3 centre = Vec3::Zero();     // its centre of mass,
  Mat3 composite = Mat3::Zero();  // and its inertia about that
  const auto aboutAxis = [](const Vec3& d) { return Mat3(skew(d) * skew(d).transpose()); };
  for (int k = arm.size() - 1; k >= 0; --k) {
    const ArmLink& link = arm.links[k];
    const Mat3 rotation = posture.q[k].toRotationMatrix();
    const double all = mass + link.mass;
    const Vec3 apart = posture.centre[k] - centre;
    composite += rotation * link.inertia * rotation.transpose();
    composite += mass * link.mass / all * aboutAxis(apart);
    centre += link.mass / all * apart;
    mass = all;
    inertia[k] = composite + mass * aboutAxis(centre - posture.pivot[k]);  // (151)
  }
}

double effortOf(const Arm& arm, const ArmPosture& posture, std::span<const Vec3> turns) {
  double twice = 0;
  Vec3 turn = Vec3::Zero(), moved = Vec3::Zero();  // of link k, and of its pivot
  for (int k = 0; k < arm.size(); ++k) {
    const Vec3 before = k == 0 ? posture.pivot[0] : posture.pivot[k - 1];
    moved += turn.cross(posture.pivot[k] - before);
    turn += turns[k];
    const Vec3 shift = moved + turn.cross(posture.centre[k] - posture.pivot[k]);
    const Vec3 own = posture.q[k].conjugate() * turn;
    twice += arm.links[k].mass * shift.squaredNorm() + own.dot(arm.links[k].inertia * own);
  }
  return 0.5 * twice;
}

Vec3 turnBetween(const ArmLink& link, const ArmJoint& a, const ArmJoint& b) {
  if (link.hinge) return (b.angle - a.angle) * link.axis;
  return logarithm(b.turn * a.turn.conjugate());
}

}  // namespace physics
