// How many substeps and sweeps the next step wants.
#include <algorithm>
#include <cmath>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// What contacts may give way by on the average of their load, of which nothing shows: as a share of
// what the thinner body is thick; or what the two move past each other in a substep of the longest,
// within which they meet, but never by a larger share of the smaller body than meshes.
constexpr double kLargestSag = 2.5e-4, kLargestSagOfWay = 1.0 / kLeastSwept;
// A column of n bodies that stand on springs buckles under its own weight where the lowest gives
// way by 2 a / n^2 (7.84 EI = q L^3). On the average of the load that is 0.38 of a cube's radius
// over (n/2)^2, n/2 being how often the contacts carry the weight of an island: a quarter of it,
// and never less than what a column of a hundred just bears (1.5e-4), nor does anything less show.
// Of what springs are drawn by from the start that alone counts, in the root mean square: what
// stands on one that is much smaller falls by that one's springs. Contacts that see joints hold
// what they carry, and may give way by what a column of one body bears: what stands on legs falls,
// too.
constexpr double kLargestOfColumn = 0.1, kLeastSag = 1.25e-4;
// What the last velocity sweep may change, of the energy that an island has in g h^2, so that what
// stands comes to rest, and of that in motion of what touches past each other: by a twentieth of
// the way in a substep, which is of first order. Of a heap of 1000, 32 substeps of 32 sweeps are
// met no closer with 1e-4, for which all sweeps are made. Turns with joints end by themselves.
constexpr double kRest = 1e-6, kMotion = 2.5e-3;
constexpr int kMostSweeps = 8;

// What goes with h^2 and is `times` too large.
int substepsFor(int present, double times) {
  return static_cast<int>(std::min<double>(std::ceil(present * std::sqrt(times)), kMostSubsteps));
}

// What goes with h, of pieces that turn by so much in a step [rad].
int substepsForTurn(double turn) {
  return static_cast<int>(std::min<double>(std::ceil(turn / kStraightTurn), kMostSubsteps));
}

}  // namespace

// What the two bodies of a contact move past each other by, as a share of `size`, the smaller's.
double SmallSteps::Impl::sagOfWay(const Model& w, const KeptContact& c, double size) const {
  const Bodies& b = w.bodies;
  const double way = w.settings.dt * (b.velocity[c.a].v - b.velocity[c.b].v).norm();
  return std::min(kLargestSagOfWay * way / size, kLargestStrain);
}

// The sag that an island bears where it stands.
double SmallSteps::Impl::sagOfColumn(BodyId root) const {
  const double column = weight[root] > 0 ? carried[root] / weight[root] : 0;
  return std::max(kLeastSag, kLargestOfColumn / std::max(column * column, 1.0));
}

// What the sag of an island is to be, as a share of what is small.
double SmallSteps::Impl::sagOf(BodyId root) const {
  const double borne = std::max(sagOfColumn(root), load[root] / carried[root]);
  return sag[root] / load[root] + std::sqrt(drawn[root] / carried[root]) / borne;
}

// The energy of islands, by their first body, that the last sweep may change.
void SmallSteps::Impl::weighMotion(const Model& w, const Batch& batch) {
  const Bodies& b = w.bodies;
  const double g = gravityOf(w);
  for (const BodyId i : batch.bodies) {
    energy[i] = whole[i] = change[i] = changeBefore[i] = 0;
    load[i] = sag[i] = drawn[i] = carried[i] = weight[i] = 0;
  }
  for (const BodyId i : batch.bodies) {
    if (b.motion[i] != Motion::kDynamic) continue;
    const double fall = g * length[i] * length[i];
    energy[islands[i]] += kRest * b.mass[i] * fall * fall;
    whole[islands[i]] += b.mass[i] * fall * fall;
    weight[islands[i]] += b.mass[i] * fall;
  }
}

// The sag of a contact under what it has carried for two steps, and what the last sweep changed.
SmallSteps::Impl::Weighed SmallSteps::Impl::weigh(const Model& w, const Batch& batch,
                                                  const ContactBlock& block, int l) const {
  const Bodies& b = w.bodies;
  const KeptContact& c = contacts[block.contact[l]];
  Weighed of;
  of.root = rootOf(w, c);
  of.change = block.change[0][l];
  of.changeBefore = block.change[1][l];
  const double mass = 1 / (b.inverse[c.a].m + b.inverse[c.b].m), h = lengthOf(b, c);
  of.motion = mass * h * h * (b.velocity[c.a].v - b.velocity[c.b].v).squaredNorm();
  const Softness law = softnessOf(b, batch, c);
  const double soft = (1 - law.scale) / (law.scale * law.rate);
  const double size = std::min(radius[c.a], radius[c.b]);
  const bool isOfJoints = isJointed(c) && !batch.isAtOnce;
  if (!(size > 0) || (isOfJoints && !meetsResponse(c))) return of;
  of.way = isOfJoints ? kLargestOfColumn : sagOfWay(w, c, size);
  of.seen = kLeastSag;
  if (!w.settings.accuracy) {  // more would show in what is asked for
    const double thinner = std::min(thickness[c.a], thickness[c.b]);
    of.seen = std::max(kLeastSag, kLargestSag * thinner / size);
  }
  for (int k = 0; k < c.count; ++k) {
    const double inverse = block.point[k].inverse[l];
    const double lambda = c.stayed(k);
    if (!(inverse > 0)) continue;
    const double held = std::min<double>(lambda, block.held[k][l]);
    const double share = lambda * soft / inverse / size;
    of.sag += share * (lambda - held);
    of.drawn += lambda * std::pow(held * soft / inverse / size, 2);
    of.carried += lambda;
  }
  return of;
}

// Of islands: summed in the order of the contacts, for the same bytes on any number of threads.
void SmallSteps::Impl::weighContacts(Model& w, const Batch& batch) {
  weighed.resize(batch.blocks.size());
  forEachGroup(w, batch, [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      const ContactBlock& block = batch.blocks[i];
      for (int l = 0; l < ContactBlock::kLanes; ++l) {
        weighed[i][l] = block.contact[l] < 0 ? Weighed{} : weigh(w, batch, block, l);
      }
    }
  });
  for (const auto& lanes : weighed) {
    for (const Weighed& of : lanes) {
      change[of.root] += of.change;
      changeBefore[of.root] += of.changeBefore;
      energy[of.root] += kMotion * of.motion;
      whole[of.root] += of.motion;
      sag[of.root] += of.sag;
      drawn[of.root] += of.drawn;
      carried[of.root] += of.carried;
    }
  }
  for (const auto& lanes : weighed) {
    for (const Weighed& of : lanes) {
      load[of.root] += of.carried * std::max(std::min(of.seen, sagOfColumn(of.root)), of.way);
    }
  }
}

// Of the last substep's length, in a step: where an accuracy chose it, another number than asked.
int SmallSteps::Impl::takenBy(const Model& w, BodyId i) const {
  return std::max(static_cast<int>(std::lround(w.settings.dt / length[i])), 1);
}

void SmallSteps::Impl::want(BodyId body, int count, SubstepLaw by) {
  if (count <= asked[body]) return;
  asked[body] = count;
  law[body] = by;
}

// The same of the overlaps of points and links, relative to their thickness.
void SmallSteps::Impl::askSoft(const Model& w, const Batch& batch) {
  const Bodies& b = w.bodies;
  if (batch.soft.empty()) return;
  for (const BodyId i : batch.bodies) load[i] = change[i] = 0;
  for (const SoftContact& c : batch.soft) {
    const BodyId root = islands[moverOf(b, c.from, c.to)];
    load[root] += c.normalTotal;
    change[root] += c.normalTotal * std::max(-gapOf(c, b.pose), 0.0) / c.radius;
  }
  for (const BodyId i : batch.bodies) {
    if (islands[i] != i || !(load[i] > 0)) continue;
    const double off = change[i] / load[i] / kLargestStrain;
    want(i, substepsFor(takenBy(w, i), off), SubstepLaw::kOverlap);
  }
}

// What joints pull turns bodies back, across what pulls: they swing by [omega h]^2 = I^-1 K, which
// has two directions. Of swings that take less than two substeps nothing is left to follow.
void SmallSteps::Impl::askJoints(const Model& w, const Batch& batch) {
  for (const int k : batch.articulations) {
    const auto bodies = articulations[k].bodies();
    double most = 0;
    for (const BodyId i : bodies) {
      most = std::max(most, 0.5 * stiffness[i].cwiseProduct(masses[i].inertia).sum());
    }
    const int taken = takenBy(w, bodies.front());
    want(bodies.front(), substepsFor(taken, most / (kPi * kPi)), SubstepLaw::kPull);
  }
}

// The same of what deformables are off by.
void SmallSteps::Impl::askDeformables(Model& w, const Batch& batch) {
  for (const BodyId i : batch.bodies) asked[i] = 0;
  for (const int k : batch.deformables) {
    const BodyId first = deformables[k].bodies().front();
    const int taken = takenBy(w, first);
    const double h = length[first];
    const double off = deformables[k].strain(w.kinds, {w.bodies.pose, w.bodies.start, h});
    want(first, substepsFor(taken, off / kLargestStrain), SubstepLaw::kStrain);
    if (!deformables[k].isDirect()) continue;
    const double turn = deformables[k].turn({w.bodies.pose, w.bodies.start, h});
    want(first, substepsForTurn(taken * turn), SubstepLaw::kTurn);
  }
}

// Contacts see the articulated mass of what carries much more than it weighs.
void SmallSteps::Impl::weighJoints(const Model& w, const Batch& batch) {
  if (batch.articulations.empty()) return;
  const Bodies& b = w.bodies;
  const double g = gravityOf(w);
  for (const int k : batch.articulations) {
    responding[k] = 0;
    for (const BodyId i : articulations[k].bodies()) load[i] = 0;
  }
  for (const int k : batch.contacts) {
    const KeptContact& c = contacts[k];
    for (int p = 0; p < c.count; ++p) {
      for (const BodyId i : {c.a, c.b}) load[i] += c.lambda[p];
    }
  }
  for (const int k : batch.articulations) {
    if (!articulations[k].holdsBothWays() || !(g > 0)) continue;
    for (const BodyId i : articulations[k].bodies()) {
      if (load[i] > kMostCarried * b.mass[i] * g * length[i] * length[i]) responding[k] = 1;
    }
  }
}

// Where sweeps do not get there; from then on for as long as what is heavy lies on what is light,
// or contacts see joints. What sweeps have yet to bring shrinks by the same share r from one to the
// next; it is change r / (1 - sqrt r)^2 of energy, and more than all that the island has.
bool SmallSteps::Impl::asksAtOnce(const Model& w, const Batch& batch, BodyId root) const {
  if (learning || batch.isSoft() || !batch.softPairs.empty()) return false;
  if (batch.isAtOnce) return batch.joined == Joined::kResponds || isOverloaded(w, batch);
  if (batch.takesTurns()) return uneven[root] && turns[root] > 0;
  if (batch.sweeps < 2 || !uneven[root] || !(change[root] > kMotion * whole[root])) return false;
  const double r = change[root] / changeBefore[root], slow = 1 - std::sqrt(r);
  return !(slow > 0) || change[root] * r > slow * slow * whole[root];
}

// Sag goes with h^2; what the last sweep changed tells whether an island is at rest.
void SmallSteps::Impl::ask(Model& w, const Batch& batch) {
  weighJoints(w, batch);
  askDeformables(w, batch);
  askJoints(w, batch);
  askSoft(w, batch);
  weighMotion(w, batch);
  weighContacts(w, batch);
  askFiner(w, batch);
  for (const BodyId i : batch.bodies) {
    const BodyId root = islands[i];
    if (load[root] > 0) {
      want(i, substepsFor(takenBy(w, root), sagOf(root)), SubstepLaw::kSag);
    }
    askedSweeps[i] = batch.takesTurns() ? 1 : batch.sweeps;
    askedAtOnce[i] = root == i && asksAtOnce(w, batch, root);
    if (batch.takesTurns()) continue;
    if (learning) {
      askedSweeps[i] = kMostSweeps;  // they go down where the motion allows it
    } else if (change[root] > energy[root]) {
      askedSweeps[i] = std::min(kMostSweeps, batch.sweeps + 1);
    } else if (batch.sweeps > 1 && changeBefore[root] <= energy[root]) {
      --askedSweeps[i];  // the last one was not needed
    }
  }
}

}  // namespace physics
