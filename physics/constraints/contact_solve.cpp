// Contact: the visit of one manifold by the sweep, (91)-(101).
#include <cmath>

#include "physics/base/rotation.h"
#include "physics/constraints/contact.h"
#include "physics/constraints/friction.h"

namespace physics {
namespace {

// Where point k is now: the arms of p_a from either centre, and what its matter has slipped.
struct Place {
  Vec3 n, armA, armB, slip;
};

Place placeOf(const ContactPair& pair, int k, const Bodies& bodies) {
  const ContactPointState& p = pair.points[k];
  const Pose &a = bodies.pose[pair.a], &b = bodies.pose[pair.b];
  Place place;
  place.n = normalOf(pair, bodies.pose);
  const Vec3 at = pointOf(pair, k, bodies.pose);
  place.armA = at - a.x;
  place.armB = at - b.x;
  const Vec3 dp = a.x + a.q * p.anchorA - b.x - b.q * p.anchorB;
  place.slip = dp - dp.dot(place.n) * place.n;
  return place;
}

// One direction d: I^-1 J_theta^T of either body, and J M^-1 J^T, (93),(94) and (97)-(99).
struct Direction {
  Vec3 d, turnA, turnB;
  double resistance;
};

Direction directionOf(const ContactPair& pair, const Place& place, const Vec3& d,
                      const Bodies& bodies) {
  const InverseMass &a = bodies.inverse[pair.a], &b = bodies.inverse[pair.b];
  const Vec3 leverA = place.armA.cross(d), leverB = place.armB.cross(d);
  Direction row{d, a.inertia * leverA, b.inertia * leverB, 0};
  row.resistance = a.m + b.m + leverA.dot(row.turnA) + leverB.dot(row.turnB);
  return row;
}

// M^-1 J^T of an impulse on a at p_a, opposite on b: equal and at one place, it turns nothing.
void give(const ContactPair& pair, const Place& place, const Vec3& impulse, Bodies& bodies) {
  const auto push = [&](BodyId body, const Vec3& arm, double sign) {
    const InverseMass& inverse = bodies.inverse[body];
    const Vec3 dx = sign * inverse.m * impulse, torque = sign * arm.cross(impulse);
    bodies.shift[body] += dx;
    displace(bodies.pose[body], dx, inverse.inertia * torque);
    if (!bodies.second.empty()) bodies.second.twist[body] += torque;
  };
  push(pair.a, place.armA, 1);
  push(pair.b, place.armB, -1);
}

// (95), on the total.
void solveNormal(ContactPair& pair, int k, Bodies& bodies, double xi) {
  ContactPointState& p = pair.points[k];
  const double c = gapOf(pair, k, bodies.pose);
  if (c >= 0 && p.normalTotal == 0) return;
  const Place place = placeOf(pair, k, bodies);
  const double resistance = directionOf(pair, place, place.n, bodies).resistance;
  if (resistance == 0) return;
  const double next = std::max(p.normalTotal - xi * c / resistance, 0.0);
  give(pair, place, (next - p.normalTotal) * place.n, bodies);
  p.normalTotal = next;
}

// (98)-(101).
void solveFriction(ContactPair& pair, int k, Bodies& bodies, double xi) {
  ContactPointState& p = pair.points[k];
  if (p.normalTotal == 0 && p.frictionTotal.isZero(0)) return;
  const Place place = placeOf(pair, k, bodies);
  const double size = place.slip.norm();
  Vec3 next = p.frictionTotal;
  if (size > 0) {
    const double resistance = directionOf(pair, place, place.slip / size, bodies).resistance;
    if (resistance == 0) return;
    next -= xi / resistance * place.slip;
  }
  next -= next.dot(place.n) * place.n;
  next *= heldShare(pair.friction, next.norm(), p.normalTotal);
  give(pair, place, next - p.frictionTotal, bodies);
  p.frictionTotal = next;
}

}  // namespace

bool solve(ContactPair& pair, Bodies& bodies, double xi) {
  for (int k = 0; k < pair.count; ++k) solveNormal(pair, k, bodies, xi);
  for (int k = 0; pair.frictional && k < pair.count; ++k) solveFriction(pair, k, bodies, xi);
  return std::isfinite(impulseOf(pair).sum());
}

}  // namespace physics
