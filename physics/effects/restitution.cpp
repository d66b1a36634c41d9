// Restitution on velocities, by a few sweeps of impulses along the normals.
#include "physics/effects/restitution.h"

namespace physics {
namespace {

bool bounces(const ContactPointState& p, double threshold) {
  return p.normalTotal > 0 && p.approach < -threshold;
}

void bounce(const ContactPair& pair, const ContactPointState& p, int k, Bodies& bodies,
            double restitution) {
  const Vec3 n = normalOf(pair, bodies.pose), point = pointOf(pair, k, bodies.pose);
  Velocity &va = bodies.velocity[pair.a], &vb = bodies.velocity[pair.b];
  const InverseMass &ma = bodies.inverse[pair.a], &mb = bodies.inverse[pair.b];
  const Vec3 ra = point - bodies.pose[pair.a].x, rb = point - bodies.pose[pair.b].x;
  const Vec3 na = ra.cross(n), nb = rb.cross(n);
  const double speed = n.dot(va.v - vb.v) + na.dot(va.w) - nb.dot(vb.w);
  const double resistance = ma.m + mb.m + na.dot(ma.inertia * na) + nb.dot(mb.inertia * nb);
  if (!(resistance > 1e-300)) return;
  const double impulse = (-restitution * p.approach - speed) / resistance;
  if (impulse <= 0) return;
  va.v += ma.m * impulse * n;
  vb.v -= mb.m * impulse * n;
  va.w += ma.inertia * (impulse * na);
  vb.w -= mb.inertia * (impulse * nb);
}

}  // namespace

void restitute(Contacts& contacts, Bodies& bodies, double restitution, double threshold) {
  constexpr int kSweeps = 4;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (ContactPair& pair : contacts.pairs) {
      for (int k = 0; k < pair.count; ++k) {
        if (bounces(pair.points[k], threshold)) {
          bounce(pair, pair.points[k], k, bodies, restitution);
        }
      }
    }
  }
}

}  // namespace physics
