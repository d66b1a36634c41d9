// The cases of the kinds that are forces, and of motors.
#include "tests/physics/case_parts.h"

namespace physics::testing {
namespace {

// Where a body was at the start of the substep, in a motion of everyday speed.
void moveStart(Random& random, Bodies& bodies) {
  for (int b = 0; b < bodies.size(); ++b) {
    displace(bodies.start[b], random.inBall(0.1), random.inBall(0.3));
  }
}

// Turns of both bodies about one axis since the start.
void turnAbout(const Vec3& n, Random& random, Bodies& bodies) {
  for (int b = 0; b < 2; ++b) {
    bodies.pose[b].q = about(n, random.uniform(-1, 1)) * bodies.start[b].q;
  }
}

}  // namespace

Spring Case<Spring>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  Spring item{{0, 1}, {}, random.uniform(50, 500), random.uniform(0, 5), random.uniform(0, 2)};
  anchorsApart(item, random, bodies);
  return item;
}
void Case<Spring>::satisfy(Spring& item, Bodies& bodies) {
  bodies.start = bodies.pose;
  item.restLength = between(item, bodies).norm();
}
Spring Case<Spring>::swapped(Spring item, const Bodies&) { return swapAnchors(item); }

VectorSpring Case<VectorSpring>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  VectorSpring item{{0, 1}, {}, random.uniform(50, 500), random.uniform(0, 5)};
  // The pair is turned by dp x f unless f is along dp: without levers and damping it is.
  item.damping = 0;
  anchorsApart(item, random, bodies);
  bodies.pose[0].q = bodies.pose[1].q = Quat::Identity();
  item.anchors = {Vec3::Zero(), Vec3::Zero()};
  return item;
}
void Case<VectorSpring>::satisfy(VectorSpring& item, Bodies& bodies) {
  bodies.start = bodies.pose;
  item.anchors[1] = bodies.pose[1].q.conjugate() * (bodies.pose[0].x - bodies.pose[1].x);
}
VectorSpring Case<VectorSpring>::swapped(VectorSpring item, const Bodies&) {
  return swapAnchors(item);
}

HardeningSpring Case<HardeningSpring>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  HardeningSpring item{{0, 1},
                       {},
                       random.uniform(50, 500),
                       random.uniform(0, 500),
                       random.uniform(0, 5),
                       random.uniform(0, 2)};
  anchorsApart(item, random, bodies);
  return item;
}
void Case<HardeningSpring>::satisfy(HardeningSpring& item, Bodies& bodies) {
  bodies.start = bodies.pose;
  item.restLength = between(item, bodies).norm();
}
HardeningSpring Case<HardeningSpring>::swapped(HardeningSpring item, const Bodies&) {
  return swapAnchors(item);
}

PointGravity Case<PointGravity>::make(Random& random, Bodies& bodies) {
  while ((bodies.pose[0].x - bodies.pose[1].x).norm() < 2 * kFar) {
    bodies.pose[1].x += random.inBall(1);
  }
  return {{0, 1}, random.uniform(1, 9), random.uniform(0, 0.3)};
}
void Case<PointGravity>::satisfy(PointGravity& item, Bodies&) { item.strength = 0; }
PointGravity Case<PointGravity>::swapped(PointGravity item, const Bodies&) { return item; }

ConstantForce Case<ConstantForce>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  return {{0}, 5 * axis(random)};
}
void Case<ConstantForce>::satisfy(ConstantForce& item, Bodies&) { item.force.setZero(); }
ConstantForce Case<ConstantForce>::swapped(ConstantForce item, const Bodies&) { return item; }

Drag Case<Drag>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  return {{0}, random.uniform(0.1, 2), random.inBall(5)};
}
void Case<Drag>::satisfy(Drag& item, Bodies& bodies) {
  bodies.start = bodies.pose;
  item.wind.setZero();
}
Drag Case<Drag>::swapped(Drag item, const Bodies&) { return item; }

PanelDrag Case<PanelDrag>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  const Vec3 &p = bodies.pose[0].x, &q = bodies.pose[1].x, &r = bodies.pose[2].x;
  const Vec3 n = (q - p).cross(r - p).normalized();  // wind that is not along the panel
  return {{0, 1, 2}, random.uniform(2, 4), 30 * n + random.inBall(9)};
}
void Case<PanelDrag>::satisfy(PanelDrag& item, Bodies& bodies) {
  bodies.start = bodies.pose;
  item.wind.setZero();
}
PanelDrag Case<PanelDrag>::swapped(PanelDrag item, const Bodies&) { return item; }

Bend Case<Bend>::make(Random& random, Bodies&) {
  return {{0, 1, 2}, random.uniform(5, 50), 0};  // its damper turns the three: Bend.DamperTurns...
}
void Case<Bend>::satisfy(Bend&, Bodies& bodies) {
  bodies.pose[1].x = 0.5 * (bodies.pose[0].x + bodies.pose[2].x);
  bodies.start = bodies.pose;
}
Bend Case<Bend>::swapped(Bend item, const Bodies&) { return item; }

Drive Case<Drive>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  const Quat off = random.rotation(2);
  const Quat target = bodies.pose[0].q.conjugate() * off * bodies.pose[1].q;
  return {{0, 1}, target, random.uniform(5, 50), random.uniform(0, 1)};
}
void Case<Drive>::toGradient(const Drive& item, Random&, Bodies& bodies) {
  bodies.pose[1].q = bodies.pose[0].q * item.target;
  bodies.start = bodies.pose;
}
void Case<Drive>::satisfy(Drive& item, Bodies& bodies) {
  bodies.start = bodies.pose;
  item.target = bodies.pose[0].q.conjugate() * bodies.pose[1].q;
}
Drive Case<Drive>::swapped(Drive item, const Bodies&) {
  item.target = item.target.conjugate();
  return item;
}

Motor Case<Motor>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  return {{0, 1}, axis(random), random.uniform(1, 9)};
}
void Case<Motor>::toGradient(const Motor& item, Random& random, Bodies& bodies) {
  turnAbout(bodies.start[0].q * item.axisI, random, bodies);
}
void Case<Motor>::satisfy(Motor& item, Bodies& bodies) {
  bodies.start = bodies.pose;
  item.speed = 0;
}
Motor Case<Motor>::swapped(Motor item, const Bodies& bodies) {
  item.axisI = -(bodies.pose[1].q.conjugate() * (bodies.pose[0].q * item.axisI));
  return item;
}

MotorTorque Case<MotorTorque>::make(Random& random, Bodies& bodies) {
  moveStart(random, bodies);
  return {{0, 1}, axis(random), random.uniform(1, 9), random.uniform(1, 9)};
}
void Case<MotorTorque>::toGradient(const MotorTorque& item, Random& random, Bodies& bodies) {
  turnAbout(bodies.start[0].q * item.axisI, random, bodies);
}
void Case<MotorTorque>::satisfy(MotorTorque& item, Bodies& bodies) {
  bodies.start = bodies.pose;
  item.stallTorque = 0;
}
MotorTorque Case<MotorTorque>::swapped(MotorTorque item, const Bodies& bodies) {
  item.axisI = -(bodies.pose[1].q.conjugate() * (bodies.pose[0].q * item.axisI));
  return item;
}

}  // namespace physics::testing
