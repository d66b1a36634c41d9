// Bodies that nothing holds: exactly, in one go; and how they hit each other.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "physics/base/profile.h"
#include "physics/motion/free_motion.h"
#include "physics/motion/restitution.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

constexpr double kKnownGap = 1e-13;  // m: 1e3 roundings of places some 1 m away
// Of a flight: how often at most its gaps are looked at, and the first of its moments.
constexpr int kLooks = 4;
constexpr double kMoment = 1.0 / 1024;

}  // namespace

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

// What touches would be closer a moment after.
bool SmallSteps::Impl::presses(const Model& w, const KeptContact& c, double moment) {
  const double gap = leastGapOf(c, w.bodies.pose);
  if (std::abs(gap) > kClose) return false;
  for (const BodyId i : {c.a, c.b}) {
    Velocity v = w.bodies.velocity[i];
    trialNow[i] = w.bodies.pose[i];
    if (isMovable(w.bodies, i)) fly(w, i, moment, trialNow[i], v);
  }
  return leastGapOf(c, trialNow) < gap - kKnownGap;
}

// No contact of the batch gives anything to its bodies as they fly on.
bool SmallSteps::Impl::mayFly(const Model& w, const Batch& batch, double time) {
  const Bodies& b = w.bodies;
  const auto isDriven = [&](BodyId i) { return b.motion[i] == Motion::kKinematic; };
  return !batch.isMixed() && std::none_of(batch.contacts.begin(), batch.contacts.end(), [&](int k) {
    const KeptContact& c = contacts[k];
    return isDriven(c.a) || isDriven(c.b) || leastGapOf(c, b.pose) < -kClose ||
           presses(w, c, kMoment * time);
  });
}

// The least gap of a batch's contacts, where its bodies are after a flight of so long [m]; of one
// that touched before, what it is wider by.
double SmallSteps::Impl::gapAfter(const Model& w, const Batch& batch, double time) {
  for (const BodyId i : batch.bodies) {
    Velocity v = w.bodies.velocity[i];
    trialNow[i] = w.bodies.pose[i];
    fly(w, i, time, trialNow[i], v);
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < batch.contacts.size(); ++k) {
    least = std::min(least, gapAtTrial(w.bodies, contacts[batch.contacts[k]]) - touchedAt[k]);
  }
  return least;
}

// How much the gaps of a batch's contacts may bend in a flight: the accelerations of their bodies
// against each other, and of points by their turn [m/s^2].
double SmallSteps::Impl::bendOf(const Model& w, const Batch& batch) const {
  const Bodies& b = w.bodies;
  const auto accelerationOf = [&](BodyId i) -> Vec3 {
    if (b.motion[i] != Motion::kDynamic) return Vec3::Zero();
    return w.settings.gravity.value_or(Vec3::Zero()) + b.inverse[i].m * w.loads[i].force;
  };
  double most = 0;
  for (const int k : batch.contacts) {
    const KeptContact& c = contacts[k];
    double bend = (accelerationOf(c.a) - accelerationOf(c.b)).norm();
    for (const BodyId i : {c.a, c.b}) {
      if (isMovable(b, i)) bend += radius[i] * b.velocity[i].w.squaredNorm();
    }
    if (c.carried) {
      bend += 2 * b.velocity[c.b].w.norm() * (b.velocity[c.a].v - b.velocity[c.b].v).norm();
    }
    most = std::max(most, bend);
  }
  return most;
}

// As long as no contact of the batch is pressed its bodies fly, to where two of them meet. Returns
// for how long.
double SmallSteps::Impl::flyToTouch(Model& w, const Batch& batch, double most) {
  constexpr int kMostSecants = 40;  // a guard: secants that halve are of order 1.44
  if (!mayFly(w, batch, most)) return 0;
  const auto gapAt = [&](double time) { return gapAfter(w, batch, time); };
  double open = 0, gap = std::numeric_limits<double>::infinity(), closed = 0, overlap = 0;
  bool touches = false;
  touchedAt.clear();
  for (const int k : batch.contacts) {
    const double now = leastGapOf(contacts[k], w.bodies.pose);
    touches = touches || !(now > kClose);
    touchedAt.push_back(now > kClose ? 0 : std::min(now, 0.0) - kKnownGap);
    gap = std::min(gap, now - touchedAt.back());
  }
  if (touches) {
    const double then = gapAt(kMoment * most);
    if (then > 0) open = kMoment * most, gap = then;
  }
  // Times yet to be looked at, the next one last: halved where a gap may close and open in between.
  const double bend = bendOf(w, batch);
  std::array<std::pair<double, double>, kLooks> looks{{{most, gapAt(most)}}};
  for (int count = 1; count > 0 && closed == 0;) {
    const auto [time, then] = looks[count - 1];
    const double between = time - open;
    const bool isSure = then > 0 && std::min(gap, then) > bend * between * between / 8;
    if (!isSure && between > most / kLooks) {
      const double half = open + between / 2;
      looks[count++] = {half, gapAt(half)};
    } else if (then > 0) {
      open = time, gap = then, --count;
    } else {
      closed = time, overlap = -then;
    }
  }
  // Secants between a time with a gap and one without; what stays is given half of its weight.
  const double known = 1e-15 * most;  // some roundings: there is no time between
  for (int k = 0; k < kMostSecants && closed - open > known; ++k) {
    const double time = (overlap * open + gap * closed) / (overlap + gap);
    const double then = gapAt(time);
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

// Bodies that flew meet: what is pressed has carried nothing.
bool SmallSteps::Impl::meets(const Model& w, const Batch& batch, double time) {
  if (batch.isMixed()) return false;
  bool isAny = false;
  for (const int k : batch.contacts) {
    if (!presses(w, contacts[k], kMoment * time)) continue;
    if (contacts[k].isLoaded()) return false;
    isAny = true;
  }
  return isAny;
}

// Where bodies meet, in no time. What it gives lasts no longer, and is no load. False: nothing
// jumped.
bool SmallSteps::Impl::hit(Model& w, Batch& batch, double time) {
  Bodies& b = w.bodies;
  if (!(b.mostRestitution > 0) || !meets(w, batch, time)) return false;
  profileScope("restitution");
  for (const BodyId i : batch.bodies) {
    takeMass(w, i);
    b.inverse[i].inertia = masses[i].inertia;
    b.start[i] = b.pose[i];
  }
  batch.impacts.pairs.clear();
  for (const int k : batch.contacts) {
    measureStart(batch.impacts.pairs.emplace_back(pairOf(contacts[k], 0)), b);
  }
  const FreeFlight flight{w.settings.gravity, w.loads, b.velocity, std::vector<bool>(b.pose.size()),
                          kMoment * time};
  const bool jumps = !restitute(batch.impacts, b, flight).empty();
  if (jumps) unload(batch);
  profileScope("");
  return jumps;
}

}  // namespace physics
