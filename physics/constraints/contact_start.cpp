// Contact: the start of a substep.
#include "physics/base/rotation.h"
#include "physics/constraints/contact.h"

namespace physics {

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
    p.gapAtStart = gapOf(pair, k, bodies.second.empty() ? bodies.start : bodies.second.origin);
    p.approach = n.dot(va.v + va.w.cross(armA) - vb.v - vb.w.cross(armB));
  }
}

void prepare(ContactPair& pair, const Bodies& bodies) {
  measureStart(pair, bodies);
  if (!bodies.second.empty()) {
    const bool isMovable = bodies.motion[pair.a] != Motion::kStatic;
    pair.step = bodies.second.step[isMovable ? pair.a : pair.b];
  }
  for (int k = 0; k < pair.count; ++k) {
    ContactPointState& p = pair.points[k];
    p.loaded = p.normalTotal > 0;
    p.normalTotal = 0;
    p.frictionTotal.setZero();
  }
}

}  // namespace physics
