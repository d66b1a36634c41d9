// Contacts into the lanes that sweep over them, and back.
#include <algorithm>
#include <bit>

#include "physics/collision/feature.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// Bits of a word; the last one is for what a body with more contacts has left.
constexpr int kColours = 64;
// Contacts are dealt to threads by parts of so many; of more parts, more lie between them.
constexpr int kLeastOfPart = 2048, kMostLevels = 5;

// The last colour of each group is the overflow: a block each.
int laneStride(int list) { return list % kColours == kColours - 1 ? ContactBlock::kLanes : 1; }

// Halvings of a batch with so many contacts.
int levelsOf(int count) {
  int levels = 0;
  while (levels < kMostLevels && count >> (levels + 1) >= kLeastOfPart) ++levels;
  return levels;
}

// Groups in the order in which they are swept, by nested dissection (George 1973): the parts, what
// crosses from one to its neighbour, what crosses between these two and the next two, and so on to
// the first cut; what responds; and by parts what meets that which does not move, and of that what
// responds. Groups of a stage share no body that moves.
struct GroupOrder {
  int levels;
  int parts() const { return 1 << levels; }
  int stages() const { return levels + 4; }
  int responding() const { return levels + 1; }  // the stage, as the next two
  int fixed() const { return levels + 2; }
  int respondingFixed() const { return levels + 3; }
  int first(int stage) const {  // group
    if (stage <= responding()) return 2 * parts() - (2 * parts() >> stage);
    return stage == fixed() ? 2 * parts() : 3 * parts() + (stage - respondingFixed());
  }
  int count() const { return first(stages()); }
};

}  // namespace

// Whether joints hold something behind one of the two.
bool SmallSteps::Impl::isJointed(const KeptContact& c) const {
  return articulationOf[c.a] >= 0 || articulationOf[c.b] >= 0;
}

// A contact is a spring of this many periods in a substep: above a quarter the energy of stacks
// rises, below it substeps are wasted; and its damping ratio. Against what cannot move it is twice
// as stiff with half of the damping; and as stiff, but damped, where joints hold more behind a body
// than the mass that the spring is of: figures that lie on stairs would jitter.
Softness SmallSteps::Impl::softnessOf(const Bodies& b, const KeptContact& c) const {
  constexpr double kPeriods = 0.25, kDamping = 2;
  const auto softness = [](double periods, double zeta) {
    const double omega = 2 * kPi * periods;  // omega h
    const double d = 1 + omega * (2 * zeta + omega);
    return Softness{static_cast<float>(1 - 1 / d), static_cast<float>(omega / (2 * zeta + omega))};
  };
  static const Softness between = softness(kPeriods, kDamping);
  static const Softness against = softness(2 * kPeriods, kDamping / 2);
  static const Softness jointed = softness(2 * kPeriods, kDamping);
  if (!(b.inverse[c.a].m > 0 && b.inverse[c.b].m > 0)) return against;
  return isJointed(c) && !meetsResponse(c) ? jointed : between;
}

// What one contact moves: a body, or all of an articulation that responds.
BodyId SmallSteps::Impl::leaderOf(BodyId i) const {
  const int k = articulationOf[i];
  return k >= 0 && responding[k] ? articulations[k].bodies().front() : i;
}

SmallSteps::Impl::Group SmallSteps::Impl::groupOf(const Bodies& b, const KeptContact& c,
                                                  int levels) const {
  const GroupOrder order{levels};
  const bool movesA = b.inverse[c.a].m > 0, movesB = b.inverse[c.b].m > 0,
             responds = meetsResponse(c);
  const auto partOf = [&](BodyId i) { return bisection.partOf(slotOf[i] - 1); };
  if (!movesA || !movesB) {
    if (responds) return {order.first(order.respondingFixed()), levels + 1};
    return {order.first(order.fixed()) + partOf(movesA ? c.a : c.b), levels + 1};
  }
  if (responds) return {order.first(order.responding()), levels};
  const int a = partOf(c.a), level = std::bit_width(static_cast<unsigned>(a ^ partOf(c.b)));
  return {order.first(level) + (a >> level), level};
}

// Of a level, whose colours begin at `first`.
int SmallSteps::Impl::colourOf(const Bodies& b, const KeptContact& c, std::size_t first) {
  const bool movesA = b.inverse[c.a].m > 0, movesB = b.inverse[c.b].m > 0;
  std::uint64_t& ofA = colours[first + (movesA ? slotOf[leaderOf(c.a)] : 0)];
  std::uint64_t& ofB = colours[first + (movesB ? slotOf[leaderOf(c.b)] : 0)];
  const std::uint64_t taken = (movesA ? ofA : 0) | (movesB ? ofB : 0);
  int colour = kColours - 1;
  if (~taken != 0) colour = std::min(__builtin_ctzll(~taken), kColours - 1);
  ofA |= std::uint64_t{1} << colour;
  ofB |= std::uint64_t{1} << colour;
  return colour;
}

// A slot to every body, where it meets anything; those of a part follow each other.
void SmallSteps::Impl::takeSlots(const Model& w, Batch& batch, int levels) {
  batch.slots.assign(1, kWorldBody);
  batch.groups.assign(1, 0);
  batch.stages.clear();
  if (batch.contacts.empty()) return batch.blocks.clear();
  batch.slots.insert(batch.slots.end(), batch.bodies.begin(), batch.bodies.end());
  bisection.divide(w.bodies.pose, levels, std::span(batch.slots).subspan(1));
  for (std::size_t s = 1; s < batch.slots.size(); ++s) slotOf[batch.slots[s]] = static_cast<int>(s);
  colours.assign((levels + 2) * batch.slots.size(), 0);
  batch.motions.assign(batch.slots.size(), LaneMotion{});
  batch.masses.assign(batch.slots.size(), LaneMass{});
  batch.inverses.resize(batch.slots.size());
  batch.before.resize(batch.slots.size());
}

// Contacts of one colour share no body that moves. First those of two bodies that move, then those
// with what does not, so that a sweep ends with nothing driven into a wall. A body with more
// contacts than there are colours has the others one by one. Of a colour those that carried come
// first, and of these those with most points: a block takes as long as its largest manifold, and
// where none carries it has no friction.
void SmallSteps::Impl::layOut(Model& w, Batch& batch) {
  constexpr int kLanes = ContactBlock::kLanes, kSorts = 2 * ContactBlock::kPoints;
  const int count = static_cast<int>(batch.contacts.size());
  const GroupOrder order{levelsOf(count)};
  takeSlots(w, batch, order.levels);
  if (batch.contacts.empty()) return;
  takeResponses(batch);
  placeOf.resize(batch.contacts.size());
  firstOf.assign(static_cast<std::size_t>(order.count()) * kColours * kSorts, 0);
  groupColours.assign(order.count(), 0);
  for (int i = 0; i < count; ++i) {
    const KeptContact& c = contacts[batch.contacts[i]];
    const Group group = groupOf(w.bodies, c, order.levels);
    const int colour = colourOf(w.bodies, c, group.level * batch.slots.size());
    const int sort = (c.isLoaded() ? 1 : 2) * ContactBlock::kPoints - std::max(c.count, 1);
    groupColours[group.place] |= std::uint64_t{1} << colour;
    placeOf[i] = (group.place * kColours + colour) * kSorts + sort;
    ++firstOf[placeOf[i]];
  }
  int lanes = 0;
  for (int stage = 0; stage < order.stages(); ++stage) {
    const int first = static_cast<int>(batch.groups.size()) - 1;
    for (int group = order.first(stage); group < order.first(stage + 1); ++group) {
      if (groupColours[group] == 0) continue;
      for (std::uint64_t left = groupColours[group]; left != 0; left &= left - 1) {
        const int list = group * kColours + std::countr_zero(left);
        for (int k = list * kSorts; k < (list + 1) * kSorts; ++k) {
          const int more = firstOf[k] * laneStride(list);
          firstOf[k] = lanes;
          lanes += more;
        }
        lanes = (lanes + kLanes - 1) / kLanes * kLanes;
      }
      batch.groups.push_back(lanes / kLanes);
    }
    const int end = static_cast<int>(batch.groups.size()) - 1;
    const bool responds = stage == order.responding() || stage == order.respondingFixed();
    if (end > first) batch.stages.push_back({first, end, responds});
  }
  batch.blocks.resize(lanes / kLanes);
  for (ContactBlock& block : batch.blocks) {
    std::fill(std::begin(block.contact), std::end(block.contact), -1);
    block.points = 1;
  }
  for (int i = 0; i < count; ++i) {
    int& place = firstOf[placeOf[i]];
    ContactBlock& block = batch.blocks[place / kLanes];
    block.contact[place % kLanes] = batch.contacts[i];
    block.points = std::max(block.points, contacts[batch.contacts[i]].count);
    place += laneStride(placeOf[i] / kSorts);
  }
  for (ContactBlock& block : batch.blocks) {
    for (int l = 0; l < kLanes; ++l) {
      if (block.contact[l] < 0) emptyLane(block, l);
    }
  }
}

namespace {

void put(float (&to)[3][8], int l, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[k][l] = static_cast<float>(v[k]);
}

// Of kept multipliers, to those of substeps of h.
double substepRatio(const KeptContact& c, double h) {
  return c.step > 0 ? (h / c.step) * (h / c.step) : 0;
}

void emptyPoint(ContactBlock& block, int k, int l) {
  ContactBlock::Point& p = block.point[k];
  put(p.wA, l, Vec3::Zero());
  put(p.wB, l, Vec3::Zero());
  block.gap[k][l] = 1;
  block.held[k][l] = p.lambda[l] = p.inverse[l] = 0;
}

// What lane l carried, of c: kept multipliers are scaled to substeps of h. `stayed`: only what has
// been carried for two steps.
void fillLoads(const KeptContact& c, double h, bool stayed, ContactBlock& block, int l) {
  double all = 0, kept = 0, scale = substepRatio(c, h);
  for (int k = 0; k < c.count; ++k) {
    const double lambda = stayed ? std::min(c.lambda[k], c.before[k]) : c.lambda[k];
    all += c.lambda[k];
    kept += lambda;
    block.point[k].lambda[l] = static_cast<float>(scale * lambda);
    block.held[k][l] = static_cast<float>(h * h * c.held[k]);
  }
  if (kept < all) scale *= kept / all;
  block.twist[l] = static_cast<float>(scale * c.twist);
  block.tangent[0].lambda[l] = static_cast<float>(scale * c.tangential.x());
  block.tangent[1].lambda[l] = static_cast<float>(scale * c.tangential.y());
  block.change[0][l] = static_cast<float>(scale * c.tangential.z());
}

// From where both bodies are pushed to the surface of a: half of the gap. Of what one surface has
// slipped along the other nothing, where the point is a's: where a is rounder it rolls, and b's
// stays behind; all of it where the point is b's. Where rows are placed within a step as well, so
// does the place on a face of b that a corner of a slides over; of edges, and elsewhere, it is
// half.
Vec3 ofGap(const ContactPoint& point, const Vec3& gap, const Vec3& n, bool isWithin) {
  const Vec3 open = gap.dot(n) * n, slip = gap - open;
  double ofSlip = 0.5;
  if (point.radiusA != point.radiusB) {
    ofSlip = point.radiusA > point.radiusB ? 0 : 1;
  } else if (isWithin && collision::isOfFacet(point.feature)) {
    ofSlip = collision::facetOwnerOf(point.feature) == collision::Owner::b ? 0 : 1;
  }
  return 0.5 * open + ofSlip * slip;
}

}  // namespace

void emptyLane(ContactBlock& block, int l) {
  block.bodyA[l] = block.bodyB[l] = 0;
  put(block.n, l, Vec3::UnitY());
  block.scale[l] = 1;
  block.push[l] = 0;
  block.rate[l] = block.staticFriction[l] = block.dynamicFriction[l] = 0;
  block.twist[l] = block.change[0][l] = block.change[1][l] = 0;
  for (auto& t : block.tangent) t.lambda[l] = 0;
  for (int k = 0; k < block.points; ++k) emptyPoint(block, k, l);
}

// The surfaces at the present poses.
void placeLane(const KeptContact& c, std::span<const Pose> pose, bool isWithin, ContactBlock& block,
               int l) {
  const Vec3 n = normalOf(c, pose), apart = pose[c.a].x - pose[c.b].x;
  const Mat3 rotationA = pose[c.a].q.toRotationMatrix(), rotationB = pose[c.b].q.toRotationMatrix();
  put(block.n, l, n);
  for (int k = 0; k < c.count; ++k) {
    ContactBlock::Point& p = block.point[k];
    const ContactPoint& shape = c.points[k];
    const Vec3 onA = rotationA * shape.coreA - shape.radiusA * n;  // from a's centre
    const Vec3 onB = rotationB * shape.coreB + shape.radiusB * n;  // from b's
    const Vec3 gap = apart + onA - onB, ofA = ofGap(shape, gap, n, isWithin);
    put(p.wA, l, onA - ofA);
    put(p.wB, l, onB + gap - ofA);
    block.gap[k][l] = static_cast<float>(gap.dot(n));
    p.inverse[l] = 1;
  }
  for (int k = c.count; k < block.points; ++k) emptyPoint(block, k, l);
}

// Rows of a block at the present poses, for a substep of its island's.
void SmallSteps::Impl::fill(const Model& w, const Batch& batch, ContactBlock& block) const {
  const Bodies& b = w.bodies;
  const bool isWithin = stepsAccurately(w, batch);
  for (int l = 0; l < ContactBlock::kLanes; ++l) {
    if (block.contact[l] < 0) continue;  // as it was laid out
    const KeptContact& c = contacts[block.contact[l]];
    block.bodyA[l] = isMovable(b, c.a) ? slotOf[c.a] : 0;
    block.bodyB[l] = isMovable(b, c.b) ? slotOf[c.b] : 0;
    const Softness soft = learning ? Softness{} : softnessOf(b, c);
    block.scale[l] = soft.scale;
    block.rate[l] = soft.rate;
    const double h = lengthOf(b, c);
    block.push[l] = static_cast<float>(w.settings.contact->maxSeparationSpeed * h);
    block.staticFriction[l] = static_cast<float>(c.friction.staticCoefficient);
    block.dynamicFriction[l] = static_cast<float>(c.friction.dynamicCoefficient);
    placeLane(c, b.pose, isWithin, block, l);
    // Of a hit nothing is kept where joints would pass it on.
    fillLoads(c, h, batch.takesTurns() && isJointed(c), block, l);
  }
}

FrictionAt SmallSteps::Impl::frictionAt(const Model& w, const Batch& batch) const {
  return {static_cast<float>(w.settings.contact->margin), stepsAccurately(w, batch)};
}

void SmallSteps::Impl::rows(Model& w, Batch& batch) {
  w.workers.forEachChunk(static_cast<int>(batch.slots.size()), kLeastBodies, [&](int from, int to) {
    for (int s = std::max(from, 1); s < to; ++s) {
      batch.masses[s] = laneMassOf(masses[batch.slots[s]]);
      batch.inverses[s] = inverseOf(batch.masses[s]);
      startRows(batch.motions[s]);
    }
  });
  const FrictionAt friction = frictionAt(w, batch);
  forEachGroup(w, batch, [&](int from, int to) {
    for (int i = from; i < to; ++i) fill(w, batch, batch.blocks[i]);
    contactKernels().prepare(&batch.blocks[from], to - from, batch.masses.data(), friction);
  });
  noteDeep(batch);
}

// Multipliers from the lanes to the contacts that are kept.
void SmallSteps::Impl::takeOver(Model& w, Batch& batch) {
  physics::takeOver(batch.softRows, batch.soft);
  forEachGroup(w, batch, [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      for (int l = 0; l < ContactBlock::kLanes; ++l) takeOver(w.bodies, batch.blocks[i], l);
    }
  });
}

void SmallSteps::Impl::takeOver(const Bodies& b, const ContactBlock& block, int l) {
  if (block.contact[l] < 0) return;
  KeptContact& c = contacts[block.contact[l]];
  const double h = lengthOf(b, c), scale = substepRatio(c, h);
  for (int k = 0; k < c.count; ++k) {
    // One that touched when it was first seen has carried its load before.
    const bool stood = c.step == 0 && block.gap[k][l] <= 0;
    c.before[k] = stood ? block.point[k].lambda[l] : scale * c.lambda[k];
    c.lambda[k] = block.point[k].lambda[l];
  }
  c.tangential.setZero();
  for (const auto& t : block.tangent) {
    c.tangential += double(t.lambda[l]) * Vec3(t.d[0][l], t.d[1][l], t.d[2][l]);
  }
  c.twist = block.twist[l];
  c.step = h;
  if (!c.isLoaded()) c.held = {};
}

}  // namespace physics
