// Islands that step by an accuracy and touch, and ropes, cloth and soft bodies that nothing
// touches: by the substeps of the default, whose error has all powers of h while nothing comes into
// touch or leaves it, and the steps are divided about where something does. Where bodies err or
// contacts change in many places at once no step resolves it: an island goes on by the default
// then, and the estimate tells. What it has been off by since is not brought back either, so that
// what its steps may err by grows with that.
//
// Each has steps and moments of its own. Contacts know nothing of the length of a substep, so that
// islands with as many to make make them in the same lanes; none feels the others.
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/base/rotation.h"
#include "physics/model/factors.h"
#include "physics/small_steps/island_plan.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

constexpr double kLeastPart = 1.0 / 1024;  // what goes with h^2 is then kKnown of the whole's
// Of a step, each at its moment: what has more is no motion to follow.
constexpr int kMostPlaces = 4;
// Of meshes every point errs in every step, and what has no powers of h shows otherwise: a column
// leaves more than this of the error, as where links draw taut and go slack. A step for it would
// have to end at each of them, so that what rows come to is taken as it is.
constexpr double kTakesAway = 0.5;
// Of the way of a step: where rows differ by less, what they lead to is nearer than the last of
// them. What they do not agree on at all would be thrown about by it.
constexpr double kAgreed = 0.1;
// Of its size: what is off by as much, a picture shows elsewhere. It goes on by the default's
// steps.
constexpr double kLost = 0.1;
// What the speeds of one row are off by, those of the next are too: over as many steps as may err
// by what is asked, 1 / kShareOfFrame, each comes to half as many of its ways. Without, 25 balls on
// a pushed box are off by 2.5e-4 by 1e-3, not by 1.1e-4. Of what contacts do not know speeds tell
// nothing.
constexpr double kGathers = 0.5 / kShareOfFrame;

bool slides(const KeptContact& c, double along, double normal) {
  constexpr double kOnCone = 1 - 1e-5;  // but for single precision
  return normal > 0 && along >= kOnCone * c.friction.dynamicCoefficient * normal;
}

}  // namespace

bool SmallSteps::Impl::stepsAccurately(const Model& w, const Batch& batch) const {
  return w.settings.accuracy && (batch.touches || !batch.deformables.empty()) &&
         batch.softPairs.empty();
}

// The largest extent of what moves [m].
double SmallSteps::Impl::sizeOf(const Bodies& b, const Batch& batch) const {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const BodyId i : batch.bodies) {
    low = low.cwiseMin(b.pose[i].x - Vec3::Constant(radius[i]));
    high = high.cwiseMax(b.pose[i].x + Vec3::Constant(radius[i]));
  }
  return (high - low).norm();
}

// What one of its steps may err by, of its size.
double SmallSteps::Impl::allowedError(const Model& w) const {
  return std::max(kShareOfFrame * *w.settings.accuracy, kKnown);
}

void SmallSteps::Impl::goBack(Bodies& b, const Batch& batch) {
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) goBack(b, batch, k);
  for (const int d : batch.deformables) deformables[d].goBack();
}

// Contacts that touch at other points at the end of a row than they did before the step, or that
// slide or stick now and did not. An impact at the end of a step that coarser rows come to, and
// finer ones do not, follows no power of h either.
void SmallSteps::Impl::countChanges(std::span<Trial* const> group, const Batch& batch) const {
  for (Trial* trial : group) trial->changes = 0;
  forEachPart(batch, [&](std::size_t i, int l, int part) {
    const ContactBlock& block = batch.blocks[i];
    const KeptContact& c = contacts[block.contact[l]];
    double sum = 0, before = 0;
    bool isElsewhere = false;
    for (int k = 0; k < c.count; ++k) {
      const double load = block.point[k].lambda[l];
      isElsewhere = isElsewhere || (load > 0) != (c.lambda[k] > 0);
      sum += load;
      before += c.lambda[k];
    }
    const double along = std::hypot(block.tangent[0].lambda[l], block.tangent[1].lambda[l]);
    group[part]->isSmooth = group[part]->isSmooth && !isElsewhere;
    group[part]->changes +=
        isElsewhere || slides(c, along, sum) != slides(c, c.tangential.norm(), before);
  });
}

// What contacts carry where a row ends, and where the one before it ended.
void SmallSteps::Impl::noteLoads(const Model& w, const Batch& batch) {
  forEachPart(batch, [&](std::size_t i, int l, int) {
    const ContactBlock& block = batch.blocks[i];
    const int contact = block.contact[l];
    const double h = lengthOf(w.bodies, contacts[contact]);
    coarserLoads[contact] = rowLoads[contact];
    for (int k = 0; k < block.points; ++k) {
      rowLoads[contact][k] = block.point[k].lambda[l] / (h * h);
    }
  });
}

// A contact gives way by its load and h^2, so that what rests would be at another place in each
// row. The load that two rows agree on, by what its bodies give way by, is the contact's: about it
// the law is, as it is about the loads that a scene starts with, and what rests is where it touches
// in all of them. What has come to rest carries it otherwise than it did on its way there.
void SmallSteps::Impl::holdLoads(const Model& w, const Trial& trial) {
  if (trial.changes > 0) return;
  const double h = w.settings.dt / trial.steps;
  const bool rests = wayAhead(w, trial) <= trial.allowed;
  for (const int contact : batches[trial.batch].contacts) {
    KeptContact& c = contacts[contact];
    if (c.isHeld() && !rests) continue;
    const PointLoads &load = rowLoads[contact], &coarser = coarserLoads[contact];
    double difference = 0;
    for (int k = 0; k < c.count; ++k) {
      difference = std::max(difference, std::abs(load[k] - coarser[k]));
    }
    const double gives = h * h * (w.bodies.inverse[c.a].m + w.bodies.inverse[c.b].m);
    if (gives * difference > trial.allowed * trial.extent) continue;
    std::copy_n(load.begin(), c.count, c.held.begin());
  }
}

// To where `reached` has the bodies, if joints hold there; else nothing moves, and joints are seen
// again where they are.
bool SmallSteps::Impl::goToReached(Model& w, Batch& batch, double h) {
  std::vector<Pose>& pose = w.bodies.pose;
  const auto swap = [&] {
    for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
      std::swap(pose[batch.bodies[k]], reached.pose[k]);
    }
  };
  swap();
  const JointStage stage = {w.kinds, pose, pose, h, masses, moved};
  if (batch.articulations.empty() || batch.joints.areNearlyClosed(stage)) return true;
  swap();
  batch.joints.seeStart(stage);
  return false;
}

// Where `reached` is, something is off the ground that the last row ends on.
bool SmallSteps::Impl::opensAtEnd(const Bodies& b, const Batch& batch) {
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) trialNow[batch.bodies[k]] = reached.pose[k];
  return std::any_of(batch.contacts.begin(), batch.contacts.end(), [&](int contact) {
    const KeptContact& c = contacts[contact];
    const PointLoads& load = rowLoads[contact];
    const bool carries =
        std::any_of(load.begin(), load.begin() + c.count, [](double of) { return of > 0; });
    return carries && gapAtTrial(b, c) > kClose;
  });
}

// What rests is left to rest: where the last row's end is known no better, it is that. And where
// contacts and joints hold there: what extrapolates does not know that nothing passes a surface,
// and opens joints by the square of what rows differ by.
void SmallSteps::Impl::takeBest(Model& w, const Trial& trial) {
  if (!trial.followsPowers()) return;
  const double gain = trial.tableau.gain(trial.extent, w.settings.dt, trial.levers);
  if (!(gain > kKnown)) return;
  Batch& batch = batches[trial.batch];
  const double h = trial.whole / trial.steps;
  reached.pose.resize(batch.bodies.size());
  reached.velocity.resize(batch.bodies.size());
  trial.tableau.best(reached.pose, reached.velocity);
  if (opensAtEnd(w.bodies, batch) || !goToReached(w, batch, h)) return;
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
    w.bodies.velocity[batch.bodies[k]] = reached.velocity[k];
  }
  for (const int d : batch.deformables) close(w, deformables[d], h);
  if (batch.deformables.empty() && !batch.isMixed()) putOnContacts(w, batch, gain * trial.extent);
}

// What rows lead to is off what holds a mesh by the square of what they differ by.
void SmallSteps::Impl::close(Model& w, Deformable& mesh, double h) {
  if (!mesh.isAtOnce()) return;
  Bodies& b = w.bodies;
  std::vector<Pose>& before = reached.pose;
  before.clear();
  for (const BodyId i : mesh.bodies()) {
    before.push_back(b.start[i]);
    b.start[i] = b.pose[i];
    moved[i] = {Vec3::Zero(), Vec3::Zero()};
  }
  mesh.keep();
  mesh.solvePositions({w.kinds, b.pose, b.start, h, masses, moved}, w.settings.dt, 0,
                      meshesClose(w), {});
  for (const BodyId i : mesh.bodies()) {
    displace(b.pose[i], moved[i].u, moved[i].theta);
    moved[i] = {h * b.velocity[i].v, h * b.velocity[i].w};
  }
  mesh.prepareVelocities(w.kinds, {b.pose, b.start, h}, masses, moved);
  mesh.sweepVelocities(masses, moved);
  mesh.goBack();
  for (std::size_t k = 0; k < before.size(); ++k) {
    const BodyId i = mesh.bodies()[k];
    b.velocity[i] = {moved[i].u / h, moved[i].theta / h};
    b.start[i] = before[k];
  }
}

// What steps that were kept have erred by beyond what they may since the bodies rested, all in all:
// of an island, as much as of the one that is off the most.
double SmallSteps::Impl::missedBy(const Batch& batch) const {
  double most = 0;
  for (const BodyId i : batch.bodies) most = std::max(most, missed[i]);
  return most;
}

void SmallSteps::Impl::miss(const Batch& batch, double error) {
  for (const BodyId i : batch.bodies) missed[i] = error;
}

// At the start of its step.
void SmallSteps::Impl::begin(const Model& w, Trial& trial) {
  Batch& batch = batches[trial.batch];
  trial.left = w.settings.dt;
  trial.extent = sizeOf(w.bodies, batch);
  trial.allowed = allowedError(w);
  trial.flights = 0;
  trial.isLaidOut = trial.needsMore = false;
  trial.told = {};
  trial.levers.clear();
  for (const BodyId i : batch.bodies) {
    trial.levers.push_back(w.bodies.inverseInertia[i].isZero(0) ? 0 : radius[i]);
  }
}

// The largest way of its points in a step by how fast they are now: over its size.
double SmallSteps::Impl::wayAhead(const Model& w, const Trial& trial) const {
  const Batch& batch = batches[trial.batch];
  double most = 0;
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
    const Velocity& v = w.bodies.velocity[batch.bodies[k]];
    most = std::max(most, v.v.norm() + trial.levers[k] * v.w.norm());
  }
  return w.settings.dt * most / trial.extent;
}

// That, and their way from where they are kept.
double SmallSteps::Impl::wayOf(const Model& w, const Trial& trial) const {
  const Batch& batch = batches[trial.batch];
  double most = 0;
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
    const Pose &now = w.bodies.pose[batch.bodies[k]], &start = batch.kept[k].pose;
    const double turn = logarithm(now.q * start.q.conjugate()).norm();
    most = std::max(most, (now.x - start.x).norm() + trial.levers[k] * turn);
  }
  return std::max(most / trial.extent, wayAhead(w, trial));
}

// The mean one of the k-th body since it was kept [m/s^2, rad/s^2].
Velocity SmallSteps::Impl::accelerationOf(const Bodies& b, const Batch& batch, std::size_t k,
                                          double time) {
  const Velocity &now = b.velocity[batch.bodies[k]], &start = batch.kept[k].velocity;
  return {(now.v - start.v) / time, (now.w - start.w) / time};
}

// What one row of a step errs by, of its size: what one of the last step's did, but for what bodies
// accelerate by otherwise. Infinite: not known.
double SmallSteps::Impl::errorOfOneRow(const Model& w, const Trial& trial) const {
  const Batch& batch = batches[trial.batch];
  const double dt = w.settings.dt;
  if (trial.changes > 0) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
    const Velocity now = accelerationOf(w.bodies, batch, k, trial.whole);
    const Velocity& before = accelerated[batch.bodies[k]];
    most = std::max(most, (now.v - before.v).norm() + trial.levers[k] * (now.w - before.w).norm());
  }
  const double errs = oneRowErrs[batch.bodies.front()];
  return errs + (errs > kKnown ? kGathers : 1) * dt * dt * most / trial.extent;
}

// What moves by less than a step may err by errs by less, whatever its substeps; and where one row
// is known to, no further one is needed. Contacts are to stand where they touch, or the row's
// substeps tell how deep they are: unless they carry next to nothing.
bool SmallSteps::Impl::mayTakeOneRow(const Model& w, const Trial& trial) const {
  if (trial.needsMore) return false;
  const Batch& batch = batches[trial.batch];
  const bool isKnown = oneRowErrs[batch.bodies.front()] <= trial.allowed;
  if (!isKnown && !(wayOf(w, trial) <= trial.allowed)) return false;
  const auto stands = [&](int contact) {
    const KeptContact& c = contacts[contact];
    if (c.isHeld()) return true;
    const double way =
        KeptContact::sumOf(c.lambda) * (w.bodies.inverse[c.a].m + w.bodies.inverse[c.b].m);
    return way <= kKnown * trial.extent;
  };
  return std::all_of(batch.contacts.begin(), batch.contacts.end(), stands);
}

// What the next step's one row is judged by.
void SmallSteps::Impl::noteMotion(const Model& w, const Trial& trial) {
  const Batch& batch = batches[trial.batch];
  for (std::size_t k = 0; k < batch.bodies.size(); ++k) {
    accelerated[batch.bodies[k]] = accelerationOf(w.bodies, batch, k, trial.whole);
  }
  double& errs = oneRowErrs[batch.bodies.front()];
  if (trial.isOneRow) {
    errs = trial.oneRowErrs;
  } else if (trial.changes > 0 || trial.columns == 1) {
    errs = std::numeric_limits<double>::infinity();
  } else {  // it goes with h
    const double dt = w.settings.dt, times = dt / trial.whole;
    const auto gain = [&](double time) {
      return times * times * trial.steps * trial.tableau.gain(trial.extent, time, trial.levers);
    };
    errs = gain(dt);
    if (errs > kKnown) errs = gain(kGathers * dt);
  }
}

// As long as nothing is pressed the bodies of its island fly, and hit each other where they meet.
void SmallSteps::Impl::fly(Model& w, Trial& trial) {
  Batch& batch = batches[trial.batch];
  while (trial.left > 0 && trial.flights < kMostPlaces) {
    const double flown = flyToTouch(w, batch, trial.left);
    trial.left = flown == trial.left ? 0 : trial.left - flown;
    const bool hasHit = trial.left > 0 && hit(w, batch, trial.left);
    if (!(flown > 0) && !hasHit) return;
    ++trial.flights;
  }
}

// What it tries next, after it has flown. False: its step is made.
bool SmallSteps::Impl::plan(Model& w, Trial& trial) {
  Batch& batch = batches[trial.batch];
  StepChoice& choice = choices[batch.bodies.front()];
  const double dt = w.settings.dt;
  fly(w, trial);
  if (!(trial.left > 0)) return false;
  keepStart(w, batch);
  // What is a hundredth of what it is off already changes nothing.
  const double off = missedBy(batch);
  trial.allowed = std::max(allowedError(w), kShareOfFrame * off);
  trial.isOneRow = mayTakeOneRow(w, trial);
  trial.isRough = !trial.isOneRow && off > std::max(*w.settings.accuracy, kLost);
  const bool isWhole = trial.isOneRow || trial.isRough;
  const double next = isWhole ? trial.left : choice.next(trial.left, dt);
  const double wanted = std::min(std::max(next, kLeastPart * dt), trial.left);
  trial.whole = nextPart(w.kinds, w.time() + (dt - trial.left), wanted, kLeastPart * dt);
  trial.isLost = !trial.isOneRow && choice.lost() > 0;
  trial.columns = trial.isOneRow || trial.isLost ? 1 : choice.columns();
  trial.most =
      std::max(trial.columns, static_cast<int>(std::ceil(batch.substeps * trial.whole / dt)));
  return true;
}

// They may try side by side. Joints, and what is given back at impacts, are an island's own.
bool SmallSteps::Impl::isAlike(const Model& w, const Trial& a, const Trial& b) const {
  const Batch &of = batches[a.batch], &other = batches[b.batch];
  const bool isFree = !of.isMixed() && !other.isMixed() && !of.isAtOnce && !other.isAtOnce &&
                      !(w.bodies.mostRestitution > 0);
  return isFree && a.most == b.most && a.columns == b.columns && a.isLost == b.isLost &&
         a.isRough == b.isRough && of.sweeps == other.sweeps;
}

// The lanes of a group: those of its only island, or of all of them.
SmallSteps::Batch& SmallSteps::Impl::lanesFor(Model& w, std::span<Trial* const> group) {
  if (group.size() == 1) {
    Batch& batch = batches[group[0]->batch];
    if (!group[0]->isLaidOut) {
      layOut(w, batch);
      batch.partOf.assign(batch.slots.size(), 0);
    }
    group[0]->isLaidOut = true;
    return batch;
  }
  clear(together);
  together.sweeps = batches[group[0]->batch].sweeps;
  together.touches = true;
  for (std::size_t part = 0; part < group.size(); ++part) {
    const Batch& batch = batches[group[part]->batch];
    group[part]->isLaidOut = false;
    together.bodies.insert(together.bodies.end(), batch.bodies.begin(), batch.bodies.end());
    together.contacts.insert(together.contacts.end(), batch.contacts.begin(), batch.contacts.end());
  }
  layOut(w, together);
  together.partOf.assign(together.slots.size(), 0);
  for (std::size_t part = 0; part < group.size(); ++part) {
    for (const BodyId i : batches[group[part]->batch].bodies) {
      together.partOf[slotOf[i]] = static_cast<int>(part);
    }
  }
  return together;
}

// From where they were kept, in so many substeps, to the next row of their tableaus.
void SmallSteps::Impl::addRow(Model& w, std::span<Trial* const> group, Batch& batch, int steps,
                              StepReport& report) {
  for (Trial* trial : group) {
    const Batch& own = batches[trial->batch];
    goBack(w.bodies, own);
    trial->steps = steps;
    for (const BodyId i : own.bodies) length[i] = trial->whole / steps;
  }
  now = w.time() + (w.settings.dt - group[0]->left);
  runSubsteps(w, batch, group[0]->whole / steps, steps, report);
  noteLoads(w, batch);
  countChanges(group, batch);
  for (Trial* trial : group) addRow(w, *trial);
}

void SmallSteps::Impl::addRow(const Model& w, Trial& trial) {
  const Batch& batch = batches[trial.batch];
  if (trial.tableau.rows() == 0) trial.error = std::numeric_limits<double>::infinity();
  reached.pose.clear();
  reached.velocity.clear();
  for (const BodyId i : batch.bodies) {
    reached.pose.push_back(w.bodies.pose[i]);
    reached.velocity.push_back(w.bodies.velocity[i]);
  }
  trial.tableau.add(trial.steps, 1, reached.pose, reached.velocity);
  trial.coarser = trial.error;
  trial.places = 0;
  if (trial.tableau.rows() == 1) return;
  trial.error = trial.tableau.difference(trial.extent, w.settings.dt, trial.levers, trial.allowed,
                                         &trial.places);
}

// Each the part of its step that it tries, by a tableau whose last row has as many substeps; and by
// further columns, where it is smooth and they do.
void SmallSteps::Impl::tryTogether(Model& w, std::vector<Trial*>& group, StepReport& report) {
  const int most = group[0]->most, columns = group[0]->columns;
  for (Trial* trial : group) {
    trial->tableau.clear(batches[trial->batch].bodies.size());
    trial->isSmooth = true;
  }
  for (int first = 1, last = columns; !group.empty(); first = ++last) {
    Batch& batch = lanesFor(w, group);
    batch.isLost = group[0]->isLost || group[0]->isRough;
    // So that rows are told from each other.
    batch.closes = columns > 1 && !batch.isMixed() && !batch.isLost;
    closings.resize(group.size());
    for (int row = first; row <= last; ++row) {
      addRow(w, group, batch, (most * row + columns - 1) / columns, report);
    }
    conclude(w, group, batch);
  }
}

// A step that is not divided, and could not close its joints, is made again as the default's is.
bool SmallSteps::Impl::makesFiner(Bodies& b, Batch& batch) {
  if (!isOpened(batch) || 2 * batch.substeps > kMostSubsteps) return false;
  goBack(b, batch);
  batch.substeps *= 2;
  batch.isAgain = true;
  for (const int k : batch.articulations) finer[k] = batch.substeps;
  return true;
}

// Where contacts change no column does better than the last row's substeps: what these err by is
// the difference to all of them. True: that is small enough, or no shorter step would help.
bool SmallSteps::Impl::isDone(Model& w, Trial& trial) {
  Batch& batch = batches[trial.batch];
  StepChoice& choice = choices[batch.bodies.front()];
  const double dt = w.settings.dt, allowed = trial.allowed;
  const bool isLost = trial.changes > kMostPlaces;
  const bool isKnown = trial.columns > 1 || trial.isOneRow;
  const bool isSmall = isKnown && trial.error <= allowed;
  const bool isMesh = !batch.deformables.empty();
  const bool isFew = (isMesh || trial.places <= kMostPlaces) && !isLost;
  const bool mayDivide = trial.whole > kLeastPart * dt && isFew && !trial.isRough;
  if (!mayDivide && makesFiner(w.bodies, batch)) {
    ++trial.told.rejected;
    return false;
  }
  if (!isSmall && mayDivide) {
    ++trial.told.rejected;
    goBack(w.bodies, batch);
    if (isKnown) {
      choice.reject(trial.whole, trial.error, {allowed});
    } else {
      choice.giveUp(0);  // one may resolve it again
    }
    return false;
  }
  if (!isSmall && !isMesh) miss(batch, missedBy(batch) + trial.error);
  if (trial.isRough) {
    choice.takeAsItIs();
    if (isMesh && trial.error <= kAgreed * wayOf(w, trial)) takeBest(w, trial);
  } else if (!isSmall) {
    choice.giveUp(isLost ? trial.error : 0);
  } else if (trial.isOneRow) {
    choice.rest();
    if (wayOf(w, trial) <= allowedError(w)) miss(batch, 0);
  } else {
    // Bodies that are off already may err by more: such rows lead nowhere, where the contacts of
    // the last one give no energy.
    if (trial.error <= allowedError(w)) takeBest(w, trial);
    choice.accept(trial.whole, trial.error, trial.coarser, {allowed}, dt);
  }
  noteMotion(w, trial);
  if (isSmall) trial.told.order = std::max(trial.told.order, trial.isOneRow ? 1 : choice.columns());
  ++trial.told.accepted;
  trial.told.least = trial.told.least > 0 ? std::min(trial.told.least, trial.whole) : trial.whole;
  trial.told.estimate += trial.error;
  trial.left = trial.whole == trial.left ? 0 : trial.left - trial.whole;
  return true;
}

// What its rows err by. True: it goes on with one more column.
bool SmallSteps::Impl::goesOn(const Model& w, Trial& trial) {
  StepChoice& choice = choices[batches[trial.batch].bodies.front()];
  if (trial.isOneRow) {
    const double way = wayOf(w, trial);
    trial.oneRowErrs = errorOfOneRow(w, trial);
    trial.error = std::min(trial.oneRowErrs, way);
    trial.isOneRow = trial.error <= trial.allowed;
    trial.needsMore = !trial.isOneRow;
  } else if (trial.isLost) {
    trial.error = choice.lost();
  } else if (!trial.followsPowers()) {
    trial.error =
        std::max(trial.error, trial.tableau.gain(trial.extent, w.settings.dt, trial.levers));
  } else if (trial.isRough) {
    trial.isRough = trial.error > trial.allowed;
  } else if (trial.error > trial.allowed) {
    const bool isMesh = !batches[trial.batch].deformables.empty();
    const bool takesAway = trial.tableau.rows() == 2 || trial.error < kTakesAway * trial.coarser;
    trial.isRough = isMesh && (choice.isRough() || !takesAway);
    return !trial.isRough && choice.extend();
  }
  return false;
}

// Of the group remain those that go on with one more column.
void SmallSteps::Impl::conclude(Model& w, std::vector<Trial*>& group, Batch& batch) {
  ends.clear();
  bool asks = false;
  for (Trial* trial : group) {
    const Batch& own = batches[trial->batch];
    if (goesOn(w, *trial)) {
      ends.push_back(Ended::kFurther);
      continue;
    }
    ends.push_back(isDone(w, *trial) ? Ended::kAccepted : Ended::kRejected);
    if (ends.back() != Ended::kAccepted) continue;
    // What it ends with, or flies on from.
    asks = asks || !(trial->left > 0) || mayFly(w, own, trial->left);
  }
  forEachPart(batch, [&](std::size_t i, int l, int part) {
    if (ends[part] != Ended::kAccepted) return;
    takeOver(w, batch.blocks[i], l, group[part]->whole);
  });
  for (std::size_t part = 0; part < group.size(); ++part) {
    if (ends[part] != Ended::kAccepted) continue;
    const double h = group[part]->whole / group[part]->steps;
    if (group[part]->columns > 1) {
      holdLoads(w, *group[part]);
    } else {
      for (const int k : batches[group[part]->batch].contacts) {
        KeptContact& c = contacts[k];
        holdNoMore(c, KeptContact::sumOf(c.lambda) / (h * h));
      }
    }
    for (const int k : batch.articulations) articulations[k].setOpened(false);
    batch.joints.finish(w.kinds, h);
    for (const int d : batch.deformables) deformables[d].finish(w.kinds, h);
  }
  if (asks) ask(w, batch);
  std::size_t kept = 0;
  for (std::size_t part = 0; part < group.size(); ++part) {
    if (ends[part] == Ended::kFurther) group[kept++] = group[part];
  }
  group.resize(kept);
}

// Islands that touch: those that have as many substeps to make, together.
void SmallSteps::Impl::advanceTouching(Model& w, StepReport& report) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < batchCount; ++k) {
    if (!stepsAccurately(w, batches[k])) continue;
    if (count == trials.size()) trials.emplace_back();
    trials[count].batch = k;
    begin(w, trials[count++]);
  }
  rowLoads.resize(contacts.size());
  coarserLoads.resize(contacts.size());
  pending.clear();
  for (std::size_t k = 0; k < count; ++k) pending.push_back(&trials[k]);
  const auto isMade = [&](Trial* trial) {
    if (plan(w, *trial)) return false;
    finish(w, *trial, report.accuracy);
    return true;
  };
  while (std::erase_if(pending, isMade), !pending.empty()) {
    waiting = pending;
    while (!waiting.empty()) {
      const Trial& first = *waiting.front();
      group.clear();
      std::erase_if(waiting, [&](Trial* trial) {
        if (trial != &first && !isAlike(w, first, *trial)) return false;
        group.push_back(trial);
        return true;
      });
      tryTogether(w, group, report);
    }
  }
}

void SmallSteps::Impl::finish(const Model& w, const Trial& trial, AccuracyReport& report) {
  const Batch& batch = batches[trial.batch];
  StepListening::tell({batch.bodies.front(), static_cast<int>(batch.bodies.size()), w.settings.dt,
                       trial.extent, trial.allowed, trial.told});
  add(trial.told, report);
  if (trial.told.accepted == 0) rest(batch);
}

// Its contacts have carried nothing.
void SmallSteps::Impl::rest(const Batch& batch) {
  unload(batch);
  for (const BodyId i : batch.bodies) {
    asked[i] = 0;
    askedSweeps[i] = 1;
  }
}

void SmallSteps::Impl::unload(const Batch& batch) {
  for (const int k : batch.contacts) {
    KeptContact& c = contacts[k];
    c.lambda = c.before = c.held = {};
    c.tangential.setZero();
    c.twist = 0;
  }
}

}  // namespace physics
