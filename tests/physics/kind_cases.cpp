// The cases of the kinds that are constraints.
#include "tests/physics/case_parts.h"

namespace physics::testing {

Volume Case<Volume>::make(Random& random, Bodies& bodies) {
  const auto x = [&](int b) -> Vec3& { return bodies.pose[b].x; };
  Vec3 n;
  do {
    x(1) = x(0) + random.inBall(2);
    x(2) = x(0) + random.inBall(2);
    n = (x(1) - x(0)).cross(x(2) - x(0));
  } while (n.norm() < 2 * kFar);
  x(3) = (x(0) + x(1) + x(2)) / 3 + random.uniform(0.3, 1.5) * n.normalized() + random.inBall(0.1);
  return {{0, 1, 2, 3}, volumeOf({x(0), x(1), x(2), x(3)}) * random.uniform(0.5, 1.5), 0};
}
void Case<Volume>::satisfy(Volume& item, Bodies& bodies) {
  item.volume = volumeOf({bodies.pose[0].x, bodies.pose[1].x, bodies.pose[2].x, bodies.pose[3].x});
}
Volume Case<Volume>::swapped(Volume item, const Bodies&) { return item; }  // an even permutation

RopeLength Case<RopeLength>::make(Random& random, Bodies& bodies) {
  for (int b = 1; b < bodies.size(); ++b) {
    while ((bodies.pose[b].x - bodies.pose[b - 1].x).norm() < kFar) {
      bodies.pose[b].x += random.inBall(1);
    }
  }
  RopeLength item{{0, 1, 2, 3, 4}, 0, false};
  item.length = rowOf(item, bodies).c[0] * random.uniform(0.4, 0.9);
  return item;
}
void Case<RopeLength>::satisfy(RopeLength& item, Bodies& bodies) {
  item.length += rowOf(item, bodies).c[0];
}
RopeLength Case<RopeLength>::swapped(RopeLength item, const Bodies&) { return item; }

Link Case<Link>::make(Random& random, Bodies& bodies) {
  Link item{{0, 1}, 0, random.uniform(0, 1e-5), false};
  while ((bodies.pose[0].x - bodies.pose[1].x).norm() < kFar) {
    bodies.pose[1].x += random.inBall(1);
  }
  item.length = (bodies.pose[0].x - bodies.pose[1].x).norm() * random.uniform(0.4, 1.5);
  return item;
}
void Case<Link>::satisfy(Link& item, Bodies& bodies) {
  item.length = (bodies.pose[0].x - bodies.pose[1].x).norm();
}
Link Case<Link>::swapped(Link item, const Bodies&) { return item; }

Distance Case<Distance>::make(Random& random, Bodies& bodies) {
  Distance item{{0, 1}, {}, 0, random.uniform(0, 1) < 0.5};
  anchorsApart(item, random, bodies);
  item.length = between(item, bodies).norm() * random.uniform(0.4, item.rope ? 0.9 : 1.5);
  return item;
}
void Case<Distance>::satisfy(Distance& item, Bodies& bodies) {
  item.length = between(item, bodies).norm();
}
Distance Case<Distance>::swapped(Distance item, const Bodies&) { return swapAnchors(item); }

ConeLimit Case<ConeLimit>::make(Random& random, Bodies& bodies) {
  ConeLimit item{{0, 1}, {}, 0};
  double phi = 0;
  do {
    item.axes = {axis(random), axis(random)};
    phi = angleOf(bodies.pose[0].q * item.axes[0], bodies.pose[1].q * item.axes[1]);
  } while (phi < kFar || phi > kPi - kFar);
  item.angle = phi * random.uniform(0.3, 0.9);
  return item;
}
void Case<ConeLimit>::satisfy(ConeLimit& item, Bodies&) { item.angle = kPi; }
ConeLimit Case<ConeLimit>::swapped(ConeLimit item, const Bodies&) {
  std::swap(item.axes[0], item.axes[1]);
  return item;
}

TwistLimit Case<TwistLimit>::make(Random& random, Bodies& bodies) {
  TwistLimit item{{0, 1}, axis(random), random.rotation(kPi), 0, 0};
  Quat d;
  do {
    item.reference = random.rotation(kPi);
    d = bodies.pose[0].q.conjugate() * bodies.pose[1].q * item.reference.conjugate();
  } while (std::hypot(d.w(), d.vec().dot(item.axisI)) < 2 * kFar || std::abs(d.w()) < kFar);
  const double tau = item.twist({bodies.pose, bodies.start, 1});
  const bool above = random.uniform(0, 1) < 0.5;
  item.low = above ? tau - 0.7 : tau + 0.2;
  item.high = item.low + 0.4;
  return item;
}
void Case<TwistLimit>::satisfy(TwistLimit& item, Bodies& bodies) {
  const double tau = item.twist({bodies.pose, bodies.start, 1});
  item.low = tau - 0.1;
  item.high = tau + 0.3;
}
TwistLimit Case<TwistLimit>::swapped(TwistLimit item, const Bodies&) {
  item.axisI = item.reference.conjugate() * item.axisI;
  item.reference = item.reference.conjugate();
  item.low = -std::exchange(item.high, -item.low);
  return item;
}

Axle Case<Axle>::make(Random& random, Bodies& bodies) {
  Axle item{{0, 1}, Vec3::UnitX(), Mat3::Identity()};
  do {
    item.axisI = axis(random);
    item.frameJ = random.rotation(kPi).toRotationMatrix();
  } while (angleOf(bodies.pose[0].q * item.axisI, bodies.pose[1].q * item.frameJ.col(2)) >
           kPi - kFar);
  return item;
}
void Case<Axle>::satisfy(Axle& item, Bodies& bodies) {
  item.axisI = bodies.pose[0].q.conjugate() * (bodies.pose[1].q * item.frameJ.col(2));
}
Axle Case<Axle>::swapped(Axle item, const Bodies&) {
  const Vec3 n = item.axisI, u = anyNormalTo(n);
  item.axisI = item.frameJ.col(2);
  item.frameJ << u, n.cross(u), n;
  return item;
}

BallSocket Case<BallSocket>::make(Random& random, Bodies& bodies) {
  BallSocket item{{0, 1}, {}};
  anchorsApart(item, random, bodies);
  return item;
}
void Case<BallSocket>::satisfy(BallSocket& item, Bodies& bodies) {
  const Vec3 p = bodies.pose[0].x + bodies.pose[0].q * item.anchors[0];
  item.anchors[1] = bodies.pose[1].q.conjugate() * (p - bodies.pose[1].x);
}
BallSocket Case<BallSocket>::swapped(BallSocket item, const Bodies&) { return swapAnchors(item); }

}  // namespace physics::testing
