// One substep of a batch: predict, positions, displace, velocities.

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/base/inverse.h"
#include "physics/base/profile.h"
#include "physics/motion/free_motion.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// The share of a substep in the mean spin of jointed bodies, and how much of the mean turns arms
// back: what turns the other way in each substep has a mean of none, and stays damped; of a swing a
// tenth of its damping is left, without which chains under a heavy end gain energy.
constexpr double kNewSpin = 0.25, kTurnedBack = 0.9;

// omega and half a substep on, by I^-1 (-omega x I omega).
Vec3 meanSpin(const Mat3& inertia, const Mat3& inverse, const Vec3& omega, double h) {
  return omega - 0.5 * h * (inverse * omega.cross(inertia * omega));
}

Mat3 worldInertia(const Mat3& r, const Vec3& principal) {
  const Mat3 scaled = r * principal.asDiagonal();
  return scaled * r.transpose();
}

Inertia kindOfInertia(const Bodies& b, BodyId i) {
  if (b.motion[i] != Motion::kDynamic) return Inertia::kGiven;
  if (b.inverseInertia[i].isZero(0)) return Inertia::kNone;
  return isIsotropic(b.inertia[i]) ? Inertia::kRound : Inertia::kOther;
}

}  // namespace

// u = h v + h^2 M^-1 f, with the inertia at X^t and, where joints pull, their geometric stiffness.
void SmallSteps::Impl::predict(Model& w, Batch& batch, bool first) {
  batch.joints.stiffen(stiffness);
  if (batch.inLanes()) return predictLanes(w, batch, first);
  forEachBody(w, batch, [&](BodyId i, int) { predictBody(w, batch, i, first); });
}

// Bodies that joints alone hold are given half of gravity and loads before they move, and half
// after: with arms that are turned back that is RATTLE, of second order in a swing. Springs work on
// positions alone, and hold all of it there.
bool SmallSteps::Impl::isHalved(const Batch& batch, BodyId i) const {
  const int k = articulationOf[i];
  return !batch.touches && k >= 0 && !articulations[k].givesWay();
}

void SmallSteps::Impl::giveOtherHalf(const Model& w, const Batch& batch, double h) {
  if (batch.articulations.empty() || batch.touches) return;
  const double kick = 0.5 * h * h;
  for (const BodyId i : batch.bodies) {
    if (inertiaOf[i] == Inertia::kGiven || !isHalved(batch, i)) continue;
    if (w.settings.gravity) moved[i].u += kick * *w.settings.gravity;
    moved[i].u += kick * w.bodies.inverse[i].m * w.loads[i].force;
    if (inertiaOf[i] != Inertia::kNone) {
      moved[i].theta += kick * (masses[i].inertia * w.loads[i].torque);
    }
  }
}

void SmallSteps::Impl::predictBody(Model& w, const Batch& batch, BodyId i, bool first) {
  Bodies& b = w.bodies;
  const double h = length[i];
  Displacement& m = moved[i];
  Velocity& v = b.velocity[i];
  b.start[i] = b.pose[i];
  if (first) takeMass(w, i);
  if (inertiaOf[i] == Inertia::kGiven) {
    m = {h * v.v, h * v.w};
    return;
  }
  const double kick = isHalved(batch, i) ? 0.5 * h : h;
  if (w.settings.gravity) v.v += kick * *w.settings.gravity;
  const bool isLoaded = !w.loaded.empty();
  if (isLoaded) v.v += kick * b.inverse[i].m * w.loads[i].force;
  m.u = h * v.v;
  if (inertiaOf[i] == Inertia::kNone ||
      (inertiaOf[i] == Inertia::kRound && !isLoaded && articulationOf[i] < 0)) {
    m.theta = h * v.w;
    return;
  }
  predictTurn(w, i, h, kick);
}

// At the start of a step.
void SmallSteps::Impl::takeMass(const Model& w, BodyId i) {
  const Bodies& b = w.bodies;
  inertiaOf[i] = kindOfInertia(b, i);
  masses[i] = {};
  if (inertiaOf[i] == Inertia::kGiven) return;
  masses[i].inverse = b.inverse[i].m;
  if (inertiaOf[i] == Inertia::kNone) return;
  const bool isRound = inertiaOf[i] == Inertia::kRound;
  const Mat3 r = isRound ? Mat3::Identity() : b.pose[i].q.toRotationMatrix();
  masses[i].inertia = worldInertia(r, b.inverseInertia[i]);
}

void SmallSteps::Impl::predictTurn(Model& w, BodyId i, double h, double kick) {
  Bodies& b = w.bodies;
  Displacement& m = moved[i];
  Velocity& v = b.velocity[i];
  const bool isRound = inertiaOf[i] == Inertia::kRound;
  const Mat3 r = isRound ? Mat3::Identity() : b.pose[i].q.toRotationMatrix();
  const Mat3 inverse = masses[i].inertia;  // of the pose that the last substep ended with
  v.w += kick * (inverse * w.loads[i].torque);
  Vec3 omega = v.w;
  const bool isResolved = h * h * omega.squaredNorm() < kResolvedTurn * kResolvedTurn;
  if (articulationOf[i] >= 0) {
    const Vec3 back = isResolved ? (kTurnedBack * omega).eval() : Vec3::Zero();
    meanSpins[i] += kNewSpin * (back - meanSpins[i]);
  }
  if (isRound && (articulationOf[i] < 0 || stiffness[i].isZero(0))) {
    m.theta = h * omega;
    return;
  }
  const Mat3 inertia = worldInertia(r, b.inertia[i]);
  if (!isRound && !isResolved && articulationOf[i] < 0) {
    omega = r * freeTurn(b.inertia[i], r.transpose() * omega, h).mean;
  } else if (!isRound) {
    omega = meanSpin(inertia, inverse, omega, h);
  }
  m.theta = h * omega;
  inertias[i] = inertia;
  spins[i] = m.theta;
  if (articulationOf[i] >= 0 && !stiffness[i].isZero(0)) {
    masses[i].inertia = inverseOrNan<Mat3>(inertia + stiffness[i]);
  }
}

// Contacts of points and links are looked for anew in every substep: their planes turn quickly.
void SmallSteps::Impl::lookAgain(Model& w, Batch& batch, double h) {
  if (batch.softPairs.empty()) {
    batch.soft.clear();
    return;
  }
  profileScope("soft_contact");
  Bodies& b = w.bodies;
  for (const BodyId i : batch.bodies) {
    w.ahead[i] = b.start[i];
    displace(w.ahead[i], moved[i].u, moved[i].theta);
  }
  std::swap(batch.soft, batch.softBefore);
  const auto touches =
      w.softCollider.find(batch.softPairs, b.pose, w.ahead, w.settings.contact->margin);
  startSoftContacts(touches, w.softCollider, b, batch.soft);
  keepSoft(batch.softBefore, h, batch.soft);
  prepareSoftRows(batch.soft, b.pose, masses, batch.softRows);
}

// X <- X + u. Contacts alone leave the lanes as they are, but where a turn of inertia changes them.
void SmallSteps::Impl::displaceAll(Model& w, Batch& batch) {
  if (batch.inLanes()) return displaceLanes(w, batch);
  const bool inLanes = !batch.blocks.empty(), alone = inLanes && !batch.isMixed();
  const bool isGiven = giveExactly(w, batch);
  forEachBody(w, batch, [&](BodyId i, int slot) {
    if (alone && !isGiven) fromLane(batch, slot);
    displaceBody(w, i);
    if (!inLanes) return;
    LaneMotion& lane = batch.motions[slot];
    for (int c = 0; c < 3; ++c) {
      lane.du[c] += lane.u[c];
      lane.dturn[c] += lane.turn[c];
    }
    if (alone && inertiaOf[i] == Inertia::kOther) toLane(batch, slot);
  });
}

void SmallSteps::Impl::displaceBody(Model& w, BodyId i) {
  Bodies& b = w.bodies;
  Displacement& m = moved[i];
  displace(b.pose[i], m.u, m.theta);
  renormalize(b.pose[i].q);
  if (inertiaOf[i] == Inertia::kGiven || inertiaOf[i] == Inertia::kNone) return;
  if (inertiaOf[i] == Inertia::kRound) {
    if (articulationOf[i] >= 0) {
      masses[i].inertia = b.inverseInertia[i].x() * Mat3::Identity();
    }
    return;
  }
  masses[i].inertia = worldInertia(b.pose[i].q.toRotationMatrix(), b.inverseInertia[i]);
  m.theta = spinAtEnd(b, i);
}

// Angular momentum is kept while the inertia turns.
Vec3 SmallSteps::Impl::spinAtEnd(const Bodies& b, BodyId i) const {
  const Vec3 given = moved[i].theta - spins[i];
  return masses[i].inertia * (inertias[i] * (length[i] * b.velocity[i].w + given));
}

// What brings joints together that are apart is no motion, nor what contacts gave in turns with it.
void SmallSteps::Impl::forgetClosing(Model& w, Batch& batch, double h) {
  if (batch.articulations.empty() || !batch.joints.findApart(change)) return;
  if (!batch.blocks.empty() && batch.takesTurns()) forgetLoads(w, batch);
  const JointStage stage = {w.kinds, w.bodies.pose, w.bodies.start, h, masses, moved};
  batch.joints.forgetClosing(stage, predicted);
  for (const int k : batch.articulations) {
    for (const BodyId i : articulations[k].bodies()) {
      if (change[i] > 0 && inertiaOf[i] == Inertia::kOther) moved[i].theta = spinAtEnd(w.bodies, i);
    }
  }
}

// The part of a mesh's way that its last step of Newton's may change.
double SmallSteps::Impl::meshesClose(const Model& w) const {
  constexpr double kAsIs = std::numeric_limits<double>::infinity();
  return w.settings.accuracy ? std::sqrt(allowedError(w)) : kAsIs;
}

// Positions of deformables and their contacts.
void SmallSteps::Impl::sweepDeformables(Model& w, Batch& batch, double h) {
  if (batch.deformables.empty() && batch.softRows.empty()) return;
  const double push = w.settings.contact ? w.settings.contact->maxSeparationSpeed * h : 0;
  const double closed = meshesClose(w);
  const JointStage stage = {w.kinds, w.bodies.pose, w.bodies.start, h, masses, moved};
  for (const int k : batch.deformables) {
    deformables[k].solvePositions(stage, w.settings.dt, push, closed, batch.softRows);
  }
  warmStart(batch.softRows, moved);
  for (int s = 0; s < kPositionSweeps; ++s) {
    for (const int k : batch.deformables) deformables[k].sweepPositions(stage);
    physics::sweepPositions(batch.softRows, push, moved);
  }
}

void SmallSteps::Impl::sweepContactVelocities(Model& w, Batch& batch, VelocitySweep which) {
  sweep(w, batch, {ContactRows::kNormal, ContactRows::kFriction},
        [&](ContactBlock* blocks, int count, ContactRows rows) {
          VelocitySweep part = which;
          part.rows = rows;
          contactKernels().sweepVelocities(blocks, count, batch.motions.data(), part);
        });
}

void SmallSteps::Impl::balanceContacts(Model& w, Batch& batch) {
  sweep(w, batch, {ContactRows::kAll}, [&](ContactBlock* blocks, int count, ContactRows) {
    contactKernels().balance(blocks, count, batch.motions.data());
  });
}

// The s-th of a substep.
void SmallSteps::Impl::sweepContactVelocities(Model& w, Batch& batch, int s) {
  profileScope("contact");
  const bool isLast = s + 1 == batch.sweeps, closes = isLast && batch.closes;
  if (learning) {
    balanceContacts(w, batch);
  } else {
    if (closes) watchVelocities(batch);
    sweepContactVelocities(w, batch, {.first = s == 0, .left = batch.sweeps - 1 - s});
    if (closes) closeVelocities(w, batch);
  }
  profileScope("direct");
}

// Of what is beyond a limit where a substep starts: as much as one of the default's would take back
// in the time that this one takes. That is no motion, and in a millionth of a second a milliradian
// is 1000 rad/s: by accuracies of 1e-1 to 1e-4, of 300 figures thrown down one to three would gain
// 5 to 190 % in a frame.
double SmallSteps::Impl::closingShare(const Model& w, BodyId root) const {
  return std::min(1.0F, static_cast<float>(length[root] * substeps[root] / w.settings.dt));
}

// Joints, contacts, joints: the last ones leave contacts open by little, and joints not at all.
void SmallSteps::Impl::solvePositions(Model& w, Batch& batch, double h) {
  const JointStage stage = {w.kinds,
                            w.bodies.pose,
                            w.bodies.start,
                            h,
                            masses,
                            moved,
                            batch.touches ? std::span<const Vec3>() : meanSpins};
  const int count = static_cast<int>(batch.blocks.size());
  profileScope("direct");
  const double most =
      h * w.settings.maxCorrectionSpeed.value_or(std::numeric_limits<double>::infinity());
  batch.joints.leave(stage, most, 1 - closingShare(w, islands[batch.bodies.front()]));
  if (count > 0 && batch.takesTurns()) {
    takeTurns(w, batch, stage);
  } else {
    batch.joints.seePositions(stage);
    for (const int k : batch.articulations) {
      for (const BodyId i : articulations[k].bodies()) predicted[i] = moved[i];
    }
    batch.joints.followPositions(stage);
    if (count > 0) solveContactPositions(w, batch, stage);
  }
  sweepDeformables(w, batch, h);
  profileScope("direct");
  batch.joints.closePositions(stage, predicted);
  if (count > 0 && batch.isMixed()) toLanes(w, batch);
}

// What friction gives to a point of what is solved at once, and what it takes back, is for all of
// it to bear: that has the last word.
void SmallSteps::Impl::sweepSoft(Batch& batch) {
  sweepVelocities(batch.softRows, moved);
  for (const int k : batch.deformables) deformables[k].sweepVelocities(masses, moved);
  if (batch.softRows.empty()) return;
  sweepVelocities(batch.softRows, moved);
  for (const int k : batch.deformables) {
    if (deformables[k].isAtOnce()) deformables[k].sweepVelocities(masses, moved);
  }
}

void SmallSteps::Impl::solveVelocities(Model& w, Batch& batch, double h) {
  const JointStage stage = {w.kinds, w.bodies.pose, w.bodies.start, h, masses, moved};
  const int count = static_cast<int>(batch.blocks.size());
  profileScope("direct");
  batch.joints.startVelocities(stage);
  for (const int k : batch.deformables) {
    deformables[k].prepareVelocities(w.kinds, {w.bodies.pose, w.bodies.start, h}, masses, moved);
  }
  measure(batch.softRows, moved);
  const bool isMixed = batch.isMixed();
  if (count > 0 && isMixed) {
    toLanes(w, batch);
    respond(batch);
  }
  if (count > 0 && batch.takesTurns()) return turnVelocities(w, batch, stage);
  for (int s = 0; s < batch.sweeps; ++s) {
    if (count > 0) {
      if (s == 0 && batch.isAtOnce && !learning) solveVelocitiesAtOnce(batch);
      sweepContactVelocities(w, batch, s);
      if (isBalanced(w, batch, s + 1)) break;
      if (!isMixed) continue;
      fromLanes(w, batch);
    } else if (batch.deformables.empty() && batch.softRows.empty()) {
      batch.joints.refineVelocities(stage);
      break;  // joints alone are solved
    }
    profileScope("direct");
    sweepSoft(batch);
    batch.joints.solveVelocities(stage);
    if (count > 0 && s + 1 < batch.sweeps) toLanes(w, batch);
  }
}

// v = u / h
void SmallSteps::Impl::takeVelocities(Model& w, Batch& batch) {
  if (batch.inLanes()) return endLanes(w, batch);
  const bool alone = !batch.blocks.empty() && !batch.isMixed(), isGiven = giveExactly(w, batch);
  forEachBody(w, batch, [&](BodyId i, int slot) {
    if (inertiaOf[i] == Inertia::kGiven) return;
    if (alone && !isGiven) fromLane(batch, slot);
    const double rate = 1 / length[i];
    w.bodies.velocity[i] = {rate * moved[i].u, rate * moved[i].theta};
  });
}

void SmallSteps::Impl::substep(Model& w, Batch& batch, double h, StepReport& report) {
  batch.positionSweeps = 1, batch.velocitySweeps = batch.sweeps;
  solvePositions(w, batch, h);
  profileScope("motion");
  displaceAll(w, batch);
  renewTurned(w, batch);
  noteGiven(w, batch);
  forgetClosing(w, batch, h);
  giveOtherHalf(w, batch, h);
  solveVelocities(w, batch, h);
  profileScope("motion");
  takeVelocities(w, batch);
  bounce(w, batch, h);
  profileScope("");
  const auto touching = static_cast<std::int64_t>(batch.contacts.size() + batch.softRows.size());
  const int visits = batch.positionSweeps + batch.velocitySweeps;
  report.iterations += visits;
  report.work.contactVisits += touching * visits;
  report.work.frictionRows += touching * batch.velocitySweeps;
  report.constraintEvaluations += touching * visits;
  for (const int k : batch.articulations) {
    report.constraintEvaluations += 3 * static_cast<std::int64_t>(articulations[k].size());
  }
  for (const int k : batch.deformables) {
    report.constraintEvaluations += 2 * static_cast<std::int64_t>(deformables[k].size());
  }
}

}  // namespace physics
