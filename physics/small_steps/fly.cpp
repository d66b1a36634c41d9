// Bodies that nothing holds: exactly, in one go.
#include <algorithm>
#include <limits>

#include "physics/motion/free_motion.h"
#include "physics/motion/restitution.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {

// A body that nothing holds, by dt.
void SmallSteps::Impl::fly(const Model& w, BodyId i, double dt, Pose& pose, Velocity& v) const {
  const Bodies& b = w.bodies;
  Vec3 gain = Vec3::Zero();
  if (b.motion[i] == Motion::kDynamic) {
    if (w.settings.gravity) gain = dt * *w.settings.gravity;
    gain += dt * b.inverse[i].m * w.loads[i].force;
  }
  pose.x += dt * (v.v + 0.5 * gain);
  v.v += gain;
  if (b.inverseInertia[i].isZero(0) || isIsotropic(b.inertia[i])) {
    v.w += dt * b.inverseInertia[i].x() * w.loads[i].torque;
    if (!v.w.isZero(0)) pose.q = (exponential(dt * v.w) * pose.q).normalized();
    return;
  }
  const Mat3 r = pose.q.toRotationMatrix();
  Vec3 omega = r.transpose() * v.w;
  omega += dt * b.inverseInertia[i].cwiseProduct(r.transpose() * w.loads[i].torque);
  const FreeTurn turn = freeTurn(b.inertia[i], omega, dt);
  const Vec3 theta = dt * (r * turn.mean);
  v.w = exponential(theta) * (r * turn.after);
  pose.q = (exponential(theta) * pose.q).normalized();
}

void SmallSteps::Impl::fly(Model& w) {
  Bodies& b = w.bodies;
  for (const BodyId i : free) {
    b.start[i] = b.pose[i];
    fly(w, i, w.settings.dt, b.pose[i], b.velocity[i]);
  }
}

// The least gap of a contact where `trialNow` has its bodies [m]; those that do not move are put
// there.
double SmallSteps::Impl::gapAtTrial(const Bodies& b, const KeptContact& c) {
  for (const BodyId i : {c.a, c.b}) {
    if (!isMovable(b, i)) trialNow[i] = b.pose[i];
  }
  return leastGapOf(c, trialNow);
}

// No contact of the batch touches.
bool SmallSteps::Impl::isOpen(const Bodies& b, const Batch& batch) const {
  return std::all_of(batch.contacts.begin(), batch.contacts.end(),
                     [&](int k) { return leastGapOf(contacts[k], b.pose) > kClose; });
}

// The least gap of a batch's contacts, where its bodies are after a flight of so long [m].
double SmallSteps::Impl::gapAfter(const Model& w, const Batch& batch, double time) {
  for (const BodyId i : batch.bodies) {
    Velocity v = w.bodies.velocity[i];
    trialNow[i] = w.bodies.pose[i];
    fly(w, i, time, trialNow[i], v);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const int k : batch.contacts) {
    least = std::min(least, gapAtTrial(w.bodies, contacts[k]));
  }
  return least;
}

// As long as nothing in the batch touches its bodies fly, to where two of them meet. Returns for
// how long.
double SmallSteps::Impl::flyToTouch(Model& w, const Batch& batch, double most) {
  constexpr double kKnownGap = 1e-13;  // m: 1e3 roundings of places some 1 m away
  // Where in a step a gap that closes and opens again is seen; and a guard: secants that halve are
  // of order 1.44.
  constexpr int kLooks = 4, kMostSecants = 40;
  const Bodies& b = w.bodies;
  const auto isDriven = [&](BodyId i) { return b.motion[i] == Motion::kKinematic; };
  const auto byDriven = [&](int k) { return isDriven(contacts[k].a) || isDriven(contacts[k].b); };
  if (batch.isMixed() || std::any_of(batch.contacts.begin(), batch.contacts.end(), byDriven)) {
    return 0;
  }
  if (!isOpen(b, batch)) return 0;
  double open = 0, gap = gapAfter(w, batch, 0), closed = 0, overlap = 0;
  for (int look = 1; look <= kLooks && closed == 0; ++look) {
    const double time = look == kLooks ? most : look * most / kLooks,
                 then = gapAfter(w, batch, time);
    if (then > 0) open = time, gap = then;
    if (!(then > 0)) closed = time, overlap = -then;
  }
  // Secants between a time with a gap and one without; what stays is given half of its weight.
  const double known = 1e-15 * most;  // some roundings: there is no time between
  for (int k = 0; k < kMostSecants && closed - open > known; ++k) {
    const double time = (overlap * open + gap * closed) / (overlap + gap);
    const double then = gapAfter(w, batch, time);
    if (then > 0) {
      open = time, gap = then, overlap *= 0.5;
    } else {
      closed = time, overlap = -then, gap *= 0.5;
    }
    if (then >= 0 && then < kKnownGap) break;
  }
  for (const BodyId i : batch.bodies) fly(w, i, open, w.bodies.pose[i], w.bodies.velocity[i]);
  return open;
}

}  // namespace physics
