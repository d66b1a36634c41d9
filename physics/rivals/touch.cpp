// Contact points for the rival methods.
#include "physics/rivals/touch.h"

#include <algorithm>

namespace physics {

Touch touchOf(const ContactPair& pair, int k, std::span<const Pose> pose) {
  const Pose &a = pose[pair.a], &b = pose[pair.b];
  const ContactPointState& p = pair.points[k];
  const Vec3 at = pointOf(pair, k, pose);
  Touch touch;
  touch.bodies = {pair.a, pair.b, kWorldBody};
  touch.weight = {1, -1, 0};
  touch.arm = {at - a.x, at - b.x, Vec3::Zero()};
  touch.n = normalOf(pair, pose);
  touch.gap = gapOf(pair, k, pose);
  touch.startGap = p.gapAtStart;
  touch.moved = (a.x + a.q * p.anchorA) - (b.x + b.q * p.anchorB);
  touch.friction = pair.friction;
  return touch;
}

Touch touchOf(const SoftContact& contact, const Bodies& bodies) {
  const Pose& b = bodies.pose[contact.body];
  const Vec3 at = pointOf(contact, bodies.pose), n = b.q * contact.normal;
  Touch touch;
  touch.bodies = {contact.body, contact.from, contact.to};
  touch.weight = {-1, 1 - contact.along, contact.along};
  touch.arm = {at - contact.radius * n - b.x, Vec3::Zero(), Vec3::Zero()};
  touch.count = contact.from == contact.to ? 2 : 3;
  touch.n = n;
  touch.gap = gapOf(contact, bodies.pose);
  touch.startGap = contact.gapAtStart;
  touch.moved = at - (b.x + b.q * contact.anchor) - contact.startSlip;
  touch.least = kLeastShare * (bodies.inverse[contact.from].m + bodies.inverse[contact.to].m);
  touch.friction = contact.friction;
  if (touch.count == 2) touch.weight[1] = 1;
  return touch;
}

TouchRow rowOf(const Touch& touch, const Vec3& d, std::span<const InverseMass> inverse) {
  TouchRow row;
  row.d = d;
  double link = 0;
  for (int b = 0; b < touch.count; ++b) {
    const InverseMass& mass = inverse[touch.bodies[b]];
    const Vec3 lever = touch.weight[b] * touch.arm[b].cross(d);
    row.linear[b] = mass.m * touch.weight[b] * d;
    row.turn[b] = mass.inertia * lever;
    const double share = touch.weight[b] * touch.weight[b] * mass.m;
    if (touch.least > 0 && b > 0) {
      link += share;
    } else {
      row.resistance += share + lever.dot(row.turn[b]);
    }
  }
  row.resistance += std::max(link, touch.least);
  return row;
}

Vec3 velocityOf(const Touch& touch, std::span<const Velocity> velocity) {
  Vec3 sum = Vec3::Zero();
  for (int b = 0; b < touch.count; ++b) {
    const Velocity& body = velocity[touch.bodies[b]];
    sum += touch.weight[b] * (body.v + body.w.cross(touch.arm[b]));
  }
  return sum;
}

void push(const Touch& touch, const TouchRow& row, double impulse, std::span<Velocity> velocity) {
  for (int b = 0; b < touch.count; ++b) {
    velocity[touch.bodies[b]].v += impulse * row.linear[b];
    velocity[touch.bodies[b]].w += impulse * row.turn[b];
  }
}

}  // namespace physics
