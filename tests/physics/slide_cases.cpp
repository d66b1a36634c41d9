// The cases of the kinds that prismatic and universal joints are made of.
#include "tests/physics/case_parts.h"

namespace physics::testing {
namespace {

Mat3 frameAbout(const Vec3& n) {
  const Vec3 u = anyNormalTo(n);
  Mat3 frame;
  frame << u, n.cross(u), n;
  return frame;
}

double slideOf(const SlideLimit& item, const Bodies& bodies) {
  return (bodies.pose[0].q * item.axisI).dot(-between(item, bodies));
}

}  // namespace

PointOnLine Case<PointOnLine>::make(Random& random, Bodies& bodies) {
  PointOnLine item{{0, 1}, {}, frameAbout(axis(random))};
  do {
    item.anchors = {random.inBall(1), random.inBall(1)};
  } while (rowOf(item, bodies).c.norm() < kFar);
  return item;
}
void Case<PointOnLine>::satisfy(PointOnLine& item, Bodies& bodies) {
  const Pose &i = bodies.pose[0], &j = bodies.pose[1];
  const Vec3 onLine = i.x + i.q * (item.anchors[0] + 0.7 * item.frameI.col(2));
  item.anchors[1] = j.q.conjugate() * (onLine - j.x);
}
// The line is the first body's, the point the second's: named in reverse they would be another
// constraint. The check reverses these once more.
PointOnLine Case<PointOnLine>::swapped(PointOnLine item, const Bodies&) {
  std::swap(item.bodies[0], item.bodies[1]);
  return item;
}

SlideLimit Case<SlideLimit>::make(Random& random, Bodies& bodies) {
  SlideLimit item{{0, 1}, {random.inBall(1), random.inBall(1)}, axis(random), 0, 0};
  const double s = slideOf(item, bodies);
  const bool above = random.uniform(0, 1) < 0.5;
  item.low = above ? s - 0.7 : s + 0.2;
  item.high = item.low + 0.4;
  return item;
}
void Case<SlideLimit>::satisfy(SlideLimit& item, Bodies& bodies) {
  item.low = slideOf(item, bodies) - 0.1;
  item.high = item.low + 0.4;
}
SlideLimit Case<SlideLimit>::swapped(SlideLimit item, const Bodies&) {
  std::swap(item.bodies[0], item.bodies[1]);  // the axis is the first body's
  return item;
}

OrientationLock Case<OrientationLock>::make(Random& random, Bodies& bodies) {
  OrientationLock item{{0, 1}};
  do {
    item.reference = random.rotation(kPi);
  } while (rowOf(item, bodies).c.norm() > kPi - kFar);
  return item;
}
void Case<OrientationLock>::satisfy(OrientationLock& item, Bodies& bodies) {
  item.reference = (bodies.pose[0].q.conjugate() * bodies.pose[1].q).normalized();
}
OrientationLock Case<OrientationLock>::swapped(OrientationLock item, const Bodies&) {
  item.reference = item.reference.conjugate();
  return item;
}

Perpendicular Case<Perpendicular>::make(Random& random, Bodies& bodies) {
  Perpendicular item{{0, 1}, {}};
  double phi = 0;
  do {
    item.axes = {axis(random), axis(random)};
    phi = angleOf(bodies.pose[0].q * item.axes[0], bodies.pose[1].q * item.axes[1]);
  } while (phi < kFar || phi > kPi - kFar);
  return item;
}
void Case<Perpendicular>::satisfy(Perpendicular& item, Bodies& bodies) {
  const Vec3 normal = anyNormalTo(bodies.pose[0].q * item.axes[0]);
  item.axes[1] = bodies.pose[1].q.conjugate() * normal;
}
Perpendicular Case<Perpendicular>::swapped(Perpendicular item, const Bodies&) {
  std::swap(item.axes[0], item.axes[1]);
  return item;
}

}  // namespace physics::testing
