// Contact of points and links.
#include "physics/constraints/soft_contact.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "physics/constraints/friction.h"

namespace physics {
namespace {

// One direction d of the contact: M^-1 J^T of body b and A.
struct SoftDirection {
  Vec3 d, turn;
  double resistance;
};

SoftDirection directionOf(const SoftContact& contact, const Vec3& d, const Vec3& arm,
                          const Bodies& bodies) {
  const double t = contact.along;
  const InverseMass& b = bodies.inverse[contact.body];
  const Vec3 lever = arm.cross(d);
  SoftDirection row{d, b.inertia * lever, 0};
  const double first = bodies.inverse[contact.from].m, second = bodies.inverse[contact.to].m;
  const double link = first * (1 - t) * (1 - t) + second * t * t;
  row.resistance = std::max(link, kLeastShare * (first + second)) + b.m + lever.dot(row.turn);
  return row;
}

void give(const SoftContact& contact, const Vec3& impulse, const Vec3& arm, Bodies& bodies) {
  const double t = contact.along;
  const Vec3 first = bodies.inverse[contact.from].m * (1 - t) * impulse;
  bodies.shift[contact.from] += first;
  bodies.pose[contact.from].x += first;
  if (t > 0) {
    const Vec3 second = bodies.inverse[contact.to].m * t * impulse;
    bodies.shift[contact.to] += second;
    bodies.pose[contact.to].x += second;
  }
  const InverseMass& b = bodies.inverse[contact.body];
  if (b.m == 0) return;
  if (!bodies.second.empty()) bodies.second.twist[contact.body] -= arm.cross(impulse);
  bodies.shift[contact.body] -= b.m * impulse;
  displace(bodies.pose[contact.body], -b.m * impulse, -(b.inertia * arm.cross(impulse)));
}

bool solveFriction(SoftContact& contact, Bodies& bodies, double xi) {
  const Pose& b = bodies.pose[contact.body];
  const Vec3 n = b.q * contact.normal, p = pointOf(contact, bodies.pose);
  const Vec3 dp = p - (b.x + b.q * contact.anchor) - contact.startSlip;
  const Vec3 slip = dp - dp.dot(n) * n;  // (100) with the projector that it needs
  const double size = slip.norm();
  Vec3 next = contact.frictionTotal;
  const Vec3 arm = p - contact.radius * n - b.x;
  if (size > 0) {
    const double resistance = directionOf(contact, slip / size, arm, bodies).resistance;
    if (!(resistance > 0)) return resistance == resistance;
    next -= xi / resistance * slip;
  }
  next -= next.dot(n) * n;
  next *= heldShare(contact.friction, next.norm(), contact.normalTotal);
  const Vec3 change = next - contact.frictionTotal;
  if (!change.allFinite()) return false;
  contact.frictionTotal = next;
  give(contact, change, arm, bodies);
  return true;
}

}  // namespace

Vec3 pointOf(const SoftContact& contact, std::span<const Pose> pose) {
  return (1 - contact.along) * pose[contact.from].x + contact.along * pose[contact.to].x;
}

double gapOf(const SoftContact& contact, std::span<const Pose> pose) {
  const Pose& b = pose[contact.body];
  const Vec3 apart = pointOf(contact, pose) - (b.x + b.q * contact.onBody);
  return apart.dot(b.q * contact.normal) - contact.radius;
}

void startSoftContacts(std::span<const SoftTouch> touches, const SoftCollider& collider,
                       const Bodies& bodies, std::vector<SoftContact>& contacts) {
  contacts.clear();
  contacts.reserve(collider.elementCount());
  for (const SoftTouch& touch : touches) {
    const SoftElement& element = collider.element(touch.element);
    const Pose& b = bodies.start[touch.body];
    SoftContact contact;
    contact.element = touch.element;
    contact.from = element.from;
    contact.to = element.to;
    contact.body = touch.body;
    contact.along = touch.along;
    contact.radius = element.radius;
    contact.onBody = touch.onBody;
    contact.normal = touch.normal;
    contact.friction = element.friction;
    contact.gapAtStart = touch.gap;
    const Vec3 p = pointOf(contact, bodies.start);
    contact.anchor = b.q.conjugate() * (p - element.radius * (b.q * touch.normal) - b.x);
    contact.startSlip = p - (b.x + b.q * contact.anchor);
    contacts.push_back(contact);
  }
}

bool solve(SoftContact& contact, Bodies& bodies, double xi) {
  const double c = gapOf(contact, bodies.pose);
  if (c >= 0 && contact.normalTotal == 0) return true;
  const Vec3 n = bodies.pose[contact.body].q * contact.normal;
  const Vec3 arm = pointOf(contact, bodies.pose) - contact.radius * n - bodies.pose[contact.body].x;
  const SoftDirection row = directionOf(contact, n, arm, bodies);
  if (!(row.resistance > 0)) return row.resistance == row.resistance;
  const double next = std::max(contact.normalTotal - xi * c / row.resistance, 0.0);  // (95)
  const double change = next - contact.normalTotal;
  if (!std::isfinite(change)) return false;
  contact.normalTotal = next;
  give(contact, change * n, arm, bodies);
  const bool slides = contact.friction.staticCoefficient > 0 &&
                      (contact.normalTotal > 0 || !contact.frictionTotal.isZero(0));
  return !slides || solveFriction(contact, bodies, xi);
}

}  // namespace physics
