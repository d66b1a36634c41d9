// Contact: the start of a substep.
#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "physics/constraints/contact.h"

namespace physics {
namespace {

// What a sticking point is off by at the end of the last substep, by its anchors of then.
Vec3 slipLeft(const ContactPointState& p, const Vec3& n, const Pose& a, const Pose& b) {
  if (!p.sticking || p.normalTotal == 0) return Vec3::Zero();
  const Vec3 dp = p.slip + (a.x + a.q * p.anchorA) - (b.x + b.q * p.anchorB);
  return dp - dp.dot(n) * n;
}

// Contacts that are this deep press on each other from all sides, and what they press balances
// itself: it does no work that would use it up, and would grow with every error of the sweeps.
// First guesses that are bounded by `farthest` are so already.
constexpr double kDeep = 1e-3;   // m
constexpr double kFading = 0.9;  // how much of it a substep begins with

// How much of the last multiplier is likely to be needed again. One that is more than twice what it
// was a substep earlier was an impact, which is over: then what there was before it.
double lastingShare(const ContactPointState& p, double farthest) {
  if (farthest == 0) return 0;
  const double most = p.gapAtStart < -kDeep && std::isinf(farthest) ? kFading : 1;
  const double reach = p.resistance * p.normalTotal;  // how far the last multiplier pushes [m]
  const double share = reach > 0 ? std::min(most, farthest / reach) : most;
  if (p.normalTotal <= 2 * p.normalBefore || p.settled) return share;
  return std::min(share, p.normalBefore / p.normalTotal);
}

// Multipliers are impulses times the step: to those of the bodies' present step.
double rescale(ContactPair& pair, const Bodies& bodies) {
  if (bodies.second.empty()) return 1;
  const bool isMovable = bodies.motion[pair.a] != Motion::kStatic;
  const double step = bodies.second.step[isMovable ? pair.a : pair.b];
  const double ratio = pair.step > 0 ? step / pair.step : 1;
  pair.step = step;
  return ratio * ratio;
}

}  // namespace

void measureStart(ContactPair& pair, const Bodies& bodies) {
  const Pose &a = bodies.start[pair.a], &b = bodies.start[pair.b];
  const Vec3 n = normalOf(pair, bodies.start);
  const Mat3 rotationA = a.q.toRotationMatrix(), rotationB = b.q.toRotationMatrix();
  const Velocity &va = bodies.velocity[pair.a], &vb = bodies.velocity[pair.b];
  for (int k = 0; k < pair.count; ++k) {
    ContactPointState& p = pair.points[k];
    const Vec3 armA = rotationA * p.shape.coreA - p.shape.radiusA * n;
    const Vec3 armB = armA + a.x - b.x;
    p.anchorA = p.shape.radiusA == 0 ? p.shape.coreA : Vec3(rotationA.transpose() * armA);
    p.anchorB = rotationB.transpose() * armB;
    p.normal = n;
    p.gapAtStart = (armB - rotationB * p.shape.coreB).dot(n) - p.shape.radiusB;
    p.gapAtAnchors = p.gapAtStart;
    if (!bodies.second.empty()) p.gapAtStart = gapOf(pair, k, bodies.second.origin);
    p.approach = n.dot(va.v + va.w.cross(armA) - vb.v - vb.w.cross(armB));
  }
}

void prepare(ContactPair& pair, Bodies& bodies, double farthest) {
  const Pose &a = bodies.start[pair.a], &b = bodies.start[pair.b];
  const Vec3 n = normalOf(pair, bodies.start);
  for (int k = 0; k < pair.count; ++k) pair.points[k].slip = slipLeft(pair.points[k], n, a, b);
  measureStart(pair, bodies);
  const double rescaled = rescale(pair, bodies);
  pair.given.setZero();
  for (int k = 0; k < pair.count; ++k) {
    ContactPointState& p = pair.points[k];
    p.normalTotal *= rescaled;
    p.frictionTotal *= rescaled;
    const double share = lastingShare(p, farthest);
    p.normalBefore = p.normalTotal;
    p.normalTotal *= share;
    p.loaded = p.normalTotal > 0;
    p.frictionTotal = share * (p.frictionTotal - p.frictionTotal.dot(n) * n);
    p.normalOnce = 0;
    p.frictionOnce.setZero();
    p.extra = p.normalTotal * n + p.frictionTotal;
  }
  push(pair, bodies);
}

void push(ContactPair& pair, Bodies& bodies) {
  const Pose &a = bodies.start[pair.a], &b = bodies.start[pair.b];
  Vec3 impulse = Vec3::Zero(), torqueA = Vec3::Zero(), torqueB = Vec3::Zero();
  for (int k = 0; k < pair.count; ++k) {
    const ContactPointState& p = pair.points[k];
    const Vec3 armA = a.q * p.anchorA;
    impulse += p.extra;
    torqueA += armA.cross(p.extra);
    torqueB += (armA + a.x - b.x).cross(p.extra);
  }
  if (impulse.isZero(0)) return;
  pair.given += impulse;
  const InverseMass &ma = bodies.inverse[pair.a], &mb = bodies.inverse[pair.b];
  bodies.shift[pair.a] += ma.m * impulse;
  bodies.shift[pair.b] -= mb.m * impulse;
  displace(bodies.pose[pair.a], ma.m * impulse, ma.inertia * torqueA);
  displace(bodies.pose[pair.b], -mb.m * impulse, -(mb.inertia * torqueB));
  if (bodies.second.empty()) return;
  bodies.second.twist[pair.a] += torqueA;
  bodies.second.twist[pair.b] -= torqueB;
}

}  // namespace physics
