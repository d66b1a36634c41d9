// What steps together: articulations by constraints, islands by contacts as well, batches of
// islands with as many substeps.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "physics/constraints/constraint_response.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {

void SmallSteps::clear(Batch& batch) {
  batch.bodies.clear();
  batch.contacts.clear();
  batch.articulations.clear();
  batch.deformables.clear();
  batch.softPairs.clear();
  batch.soft.clear();
  batch.softRows.clear();
  batch.motions.clear();
  batch.masses.clear();
  batch.slots.clear();
  batch.isAtOnce = batch.isAgain = batch.isLost = batch.isDeep = batch.closes = false;
}

// Bodies that constraints join make an articulation; points, and what has a factor that would fill
// up, a deformable.
void SmallSteps::Impl::learn(Model& w) {
  makeRoom(w.bodies.pose.size());
  if (known && articulationOf.size() == w.bodies.pose.size()) return;
  known = true;
  for (BodyId i = 0; i < w.bodies.size(); ++i) {
    radius[i] = boundingRadius(w.bodies.shape[i]);
    thickness[i] = w.collider.thickness(i);
  }
  const Islands& joined = jointIslands(w);
  std::vector<std::vector<JointRef>> rows(joined.size());
  std::vector<BodyId> roots;
  int place = 0;
  forEachKind(w.kinds, [&](const auto& kind) {
    for (std::size_t k = 0; k < kind.set.items.size(); ++k) {
      if (isLoad(w, kind.set.items[k])) continue;
      const BodyId mover = moverOf(kind.set.items[k], w.bodies);
      if (mover == kWorldBody) continue;
      auto& list = rows[joined[mover]];
      if (list.empty()) roots.push_back(joined[mover]);
      list.push_back({place, static_cast<int>(k)});
    }
    ++place;
  });
  std::sort(roots.begin(), roots.end());
  articulations.clear();
  deformables.clear();
  topologies.clear();
  articulationOf.assign(w.bodies.pose.size(), -1);
  deformableOf.assign(w.bodies.pose.size(), -1);
  responding.clear();
  articulatedMass.clear();
  learnAccurate(w, rows);
  finer.clear();
  for (const BodyId root : roots) {
    SweptRows swept = swept::rowsOf(rows[root], w.kinds);
    const Mesh mesh = meshOf(swept, w.bodies.inverse);
    const bool isDirect = mesh.fill <= (mesh.points ? kMostFillOfPoints : kMostFill);
    if (mesh.points || !isDirect) {
      deformables.emplace_back(std::move(swept), w.kinds, w.bodies.inverse, isDirect);
      for (const BodyId i : deformables.back().bodies()) {
        deformableOf[i] = static_cast<int>(deformables.size()) - 1;
      }
    } else {
      articulations.emplace_back(rows[root], w.kinds, w.bodies.inverse, topologies);
      responding.push_back(0);
      finer.push_back(0);
      const Articulation& last = articulations.back();
      const bool hangs = last.allBodies().size() > last.bodies().size();
      articulatedMass.push_back(hangs ? std::numeric_limits<double>::infinity() : 0);
      for (const BodyId i : articulations.back().bodies()) {
        articulatedMass.back() += w.bodies.mass[i];
        articulationOf[i] = static_cast<int>(articulations.size()) - 1;
      }
    }
  }
}

namespace {

BodyId moverOf(const Bodies& b, const KeptContact& c) { return moverOf(b, c.a, c.b); }

// The velocity with which a body meets another in the step: where nothing holds it yet it falls.
Vec3 meetingVelocity(const Model& w, const KeptContact& c, BodyId i) {
  const Vec3& v = w.bodies.velocity[i].v;
  const bool falls = w.settings.gravity && w.bodies.motion[i] == Motion::kDynamic && !c.isLoaded();
  return falls ? (v + w.settings.dt * *w.settings.gravity).eval() : v;
}

// The largest speed that two bodies have along the normal, at a point of their contact.
double approachOf(const Model& w, const KeptContact& c) {
  const Bodies& b = w.bodies;
  const Vec3 n = normalOf(c, b.pose);
  const auto speedOf = [&](BodyId i, const Vec3& core) {
    return n.dot(meetingVelocity(w, c, i) + b.velocity[i].w.cross(b.pose[i].q * core));
  };
  double most = 0;
  for (int k = 0; k < c.count; ++k) {
    const double speed = speedOf(c.a, c.points[k].coreA) - speedOf(c.b, c.points[k].coreB);
    most = std::max(most, std::abs(speed));
  }
  return most;
}

}  // namespace

// So that nothing comes further into another in a substep than a share of the smaller of both: what
// is pushed on has to move before its neighbours are reached.
int SmallSteps::Impl::substepsForApproach(const Model& w, const KeptContact& c) const {
  constexpr double kLargestWay = 0.1;
  const Bodies& b = w.bodies;
  const double size = std::min(radius[c.a], radius[c.b]);
  if (!(size > 0)) return 1;
  const auto turning = [&](BodyId i) {
    const double spin = b.velocity[i].w.norm();
    return spin > 0 ? radius[i] * spin : 0;
  };
  const Vec3 relative = meetingVelocity(w, c, c.a) - meetingVelocity(w, c, c.b);
  const double most = relative.norm() + turning(c.a) + turning(c.b);
  const double allowed = kLargestWay * size / w.settings.dt;  // in a substep, by their number
  if (most <= allowed * w.settings.substepCount()) return 1;
  const double count = std::ceil(approachOf(w, c) / allowed);
  return static_cast<int>(std::min<double>(count, kMostSubsteps));
}

// Faster than by falling for two steps. Where nothing falls nothing is pressed flat, and sweeps
// bring what is left of a hit in the steps that follow.
bool SmallSteps::Impl::isHit(const Model& w, const KeptContact& c) {
  const double g = gravityOf(w);
  return g > 0 && approachOf(w, c) > 2 * g * w.settings.dt;
}

// Of an island, by its first body. What touches and what does not are apart: joints are closed
// further where no contact pushes. So are islands whose contacts know other things of joints.
SmallSteps::Batch& SmallSteps::Impl::batchFor(const Model& w, BodyId root) {
  const bool touches = held[root] == Held::kTouching;
  const bool isAtOnce = touches && atOnce[root] && !deforms[root] && !hangs[root];
  // Its steps are its own, or its loads, or its turns.
  const bool turnsSoft = deforms[root] && joined[root] == Joined::kTakesTurns;
  const bool isAlone = (w.settings.accuracy && (touches || deforms[root])) || isAtOnce ||
                       turnsSoft || (learning && rounds[root].isAlone);
  for (std::size_t k = 0; k < batchCount && !isAlone; ++k) {
    const Batch& batch = batches[k];
    if (batch.substeps == substeps[root] && batch.sweeps == sweeps[root] &&
        batch.touches == touches && batch.joined == joined[root] && !batch.isAtOnce) {
      return batches[k];
    }
  }
  if (batchCount == batches.size()) batches.emplace_back();
  Batch& batch = batches[batchCount++];
  clear(batch);
  batch.substeps = substeps[root];
  batch.sweeps = sweeps[root];
  batch.touches = touches;
  batch.joined = joined[root];
  batch.isAtOnce = isAtOnce;
  return batch;
}

// The end of a point or link that moves.
BodyId SmallSteps::Impl::softMoverOf(const Model& w, const SoftPair& pair) const {
  const SoftElement& element = w.softCollider.element(pair.element);
  return moverOf(w.bodies, element.from, element.to);
}

void SmallSteps::Impl::joinSoft(const Model& w, const SoftPair& pair) {
  const SoftElement& element = w.softCollider.element(pair.element);
  join(w.bodies, islands, element.from, element.to);
  join(w.bodies, islands, softMoverOf(w, pair), pair.body);
}

// The island of a contact, by its first body.
BodyId SmallSteps::Impl::rootOf(const Model& w, const KeptContact& c) const {
  return islands[moverOf(w.bodies, c)];
}

// The same, of a lane.
BodyId SmallSteps::Impl::rootOf(const Batch& batch, const ContactBlock& block, int lane) const {
  return islands[batch.slots[moverIn(block, lane)]];
}

// The substep of that island [s].
double SmallSteps::Impl::lengthOf(const Bodies& b, const KeptContact& c) const {
  return length[moverOf(b, c)];
}

// Substeps that a body's island takes at the least.
int SmallSteps::Impl::leastOf(const Model& w, BodyId i) const {
  if (w.settings.substeps) return *w.settings.substeps;
  const BodyId root = islands[i];
  const bool isPoint = std::holds_alternative<PointShape>(w.bodies.shape[i]);
  if (isPoint || deformableOf[i] >= 0) return kLeastSwept;
  // A step that knows what it errs by, of what is where it should be, needs no more for safety; nor
  // does one that is exact.
  const bool isKnown = !(missed[i] > 0) || oneRowErrs[root] <= kKnown;
  if (w.settings.accuracy && isKnown && choices[root].resolves()) return 1;
  const bool isTouching = held[root] == Held::kTouching;
  const bool isSwept = isTouching && (joined[root] == Joined::kNot || atOnce[root]);
  return isSwept ? kLeastSwept : kLeastSolved;
}

// Islands by constraints and contacts, and what each asks for.
void SmallSteps::Impl::divide(Model& w) {
  const Bodies& b = w.bodies;
  islands = jointIslands(w);
  for (const KeptContact& c : contacts) join(b, islands, c.a, c.b);
  for (const SoftPair& pair : softPairs) joinSoft(w, pair);
  settle(islands, b.active);
  for (const BodyId i : b.active) {
    batchOf[i] = -1;
    held[i] = Held::kNot;
    joined[i] = Joined::kNot;
    deforms[i] = 0;
    substeps[i] = 1;
    sweeps[i] = 1;
    atOnce[i] = uneven[i] = hangs[i] = 0;
  }
  for (const BodyId i : b.active) {
    const BodyId root = islands[i];
    substeps[root] = std::max(substeps[root], asked[i]);
    sweeps[root] = std::max(sweeps[root], askedSweeps[i]);
    atOnce[root] = std::max(atOnce[root], std::exchange(askedAtOnce[i], char{0}));
    if (const int k = articulationOf[i]; k >= 0) {
      if (!std::isfinite(articulatedMass[k])) hangs[root] = 1;
      joined[root] =
          std::max(joined[root], responding[k] ? Joined::kResponds : Joined::kTakesTurns);
    }
    if (articulationOf[i] >= 0 || deformableOf[i] >= 0) held[root] = Held::kJoined;
    if (deformableOf[i] >= 0) deforms[root] = 1;
  }
  forApproach.resize(contacts.size());
  w.workers.forEachChunk(static_cast<int>(contacts.size()), kLeastContacts, [&](int from, int to) {
    for (int k = from; k < to; ++k) forApproach[k] = substepsForApproach(w, contacts[k]);
  });
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const BodyId root = rootOf(w, contacts[k]);
    held[root] = Held::kTouching;
    want(root, forApproach[k], SubstepLaw::kApproach);
    if (lightMass(b, contacts[k]) > 0) {
      uneven[root] = 1;
      if (isHit(w, contacts[k])) atOnce[root] = 1;
    }
    substeps[root] = std::max(substeps[root], asked[root]);
  }
  for (const SoftPair& pair : softPairs) {
    Held& island = held[islands[softMoverOf(w, pair)]];
    island = std::max(island, Held::kJoined);
  }
  for (const BodyId i : b.active) {
    substeps[islands[i]] = std::max(substeps[islands[i]], leastOf(w, i));
  }
}

// Contacts of points and links to the batch of their island.
void SmallSteps::Impl::assignSoft(Model& w) {
  for (const SoftPair& pair : softPairs) {
    batches[batchOf[softMoverOf(w, pair)]].softPairs.push_back(pair);
  }
  std::erase_if(w.softContacts, [&](const SoftContact& c) {
    const BodyId body = moverOf(w.bodies, c.from, c.to);
    if (batchOf[body] >= 0) batches[batchOf[body]].soft.push_back(c);
    return true;
  });
}

// Islands to the batch that each steps with, but for those that have stepped.
void SmallSteps::Impl::assign(Model& w) {
  batchCount = 0;
  free.clear();
  for (const BodyId i : w.bodies.active) assign(w, i);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    batches[batchOf[moverOf(w.bodies, contacts[k])]].contacts.push_back(static_cast<int>(k));
  }
  assignSoft(w);
}

void SmallSteps::Impl::assign(const Model& w, BodyId i) {
  const BodyId root = islands[i];
  if (batchOf[root] == kByItself) return;
  if (held[root] == Held::kNot) {
    free.push_back(i);
    return;
  }
  if (batchOf[root] < 0) {
    const Batch& batch = batchFor(w, root);
    batchOf[root] = static_cast<int>(&batch - batches.data());
  }
  batchOf[i] = batchOf[root];
  substeps[i] = substeps[root];
  Batch& batch = batches[batchOf[i]];
  batch.bodies.push_back(i);
  const int articulation = articulationOf[i];
  if (articulation >= 0 && articulations[articulation].bodies().front() == i) {
    batch.articulations.push_back(articulation);
  }
  const int deformable = deformableOf[i];
  if (deformable >= 0 && deformables[deformable].bodies().front() == i) {
    batch.deformables.push_back(deformable);
  }
}

}  // namespace physics
