// Contacts into the lanes that sweep over them, and back.
#include <algorithm>
#include <atomic>

#include "physics/collision/feature.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {

// Whether joints hold something behind one of the two.
bool SmallSteps::Impl::isJointed(const KeptContact& c) const {
  return articulationOf[c.a] >= 0 || articulationOf[c.b] >= 0;
}

// A contact is a spring of this many periods in a substep: above a quarter the energy of stacks
// rises, below it substeps are wasted; and its damping ratio. Against what cannot move it is twice
// as stiff with half of the damping; and as stiff, but damped, where joints hold more behind a body
// than the mass that the spring is of: figures that lie on stairs would jitter. What is solved at
// once resolves any spring: two periods take three quarters of an overlap back in a substep, and
// sag a sixty-fourth of what a quarter does.
Softness SmallSteps::Impl::softnessOf(const Bodies& b, const Batch& batch,
                                      const KeptContact& c) const {
  constexpr double kPeriods = 0.25, kDamping = 2, kPeriodsAtOnce = 2;
  const auto softness = [](double periods, double zeta) {
    const double omega = 2 * kPi * periods;  // omega h
    const double d = 1 + omega * (2 * zeta + omega);
    return Softness{static_cast<float>(1 - 1 / d), static_cast<float>(omega / (2 * zeta + omega))};
  };
  static const Softness between = softness(kPeriods, kDamping);
  static const Softness against = softness(2 * kPeriods, kDamping / 2);
  static const Softness jointed = softness(2 * kPeriods, kDamping);
  static const Softness atOnce = softness(kPeriodsAtOnce, kDamping);
  if (batch.isAtOnce) return atOnce;
  if (!(b.inverse[c.a].m > 0 && b.inverse[c.b].m > 0)) return against;
  return isJointed(c) && !meetsResponse(c) ? jointed : between;
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

// What lane l carried, of c: kept multipliers are scaled to substeps of h. `noMore`: than
// has been carried before, all in all. Where steps differ in length, what an impact gave within a
// short one would throw the bodies in a longer, as a force.
void fillLoads(const KeptContact& c, double h, bool noMore, ContactBlock& block, int l) {
  const double scale = substepRatio(c, h);
  const double before = KeptContact::sumOf(c.before), now = KeptContact::sumOf(c.lambda);
  const double kept = noMore && before < now ? scale * before / now : scale;
  for (int k = 0; k < c.count; ++k) {
    block.point[k].lambda[l] = static_cast<float>(kept * c.lambda[k]);
    block.held[k][l] = static_cast<float>(h * h * c.held[k]);
  }
  block.lasted[l] = static_cast<float>(scale * before);
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
  block.push[l] = block.lasted[l] = 0;
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
  const bool isAsked = stepsAccurately(w, batch), isWithin = isAsked && !batch.isLost;
  for (int l = 0; l < ContactBlock::kLanes; ++l) {
    if (block.contact[l] < 0) continue;  // as it was laid out
    const KeptContact& c = contacts[block.contact[l]];
    const Softness soft = learning ? Softness{} : softnessOf(b, batch, c);
    block.scale[l] = soft.scale;
    block.rate[l] = soft.rate;
    const double h = lengthOf(b, c);
    block.push[l] = static_cast<float>(w.settings.contact->maxSeparationSpeed * h);
    block.staticFriction[l] = static_cast<float>(c.friction.staticCoefficient);
    block.dynamicFriction[l] = static_cast<float>(c.friction.dynamicCoefficient);
    placeLane(c, b.pose, isWithin, block, l);
    fillLoads(c, h, isAsked, block, l);
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
      batch.motions[s] = {};
      if (batch.inLanes()) takeRoot(batch, s);
    }
  });
  layAtOnce(batch);
  const FrictionAt friction = frictionAt(w, batch);
  std::atomic<bool> someDeep = false;
  forEachGroup(w, batch, [&](int from, int to) {
    const std::span<ContactBlock> blocks(&batch.blocks[from], to - from);
    for (ContactBlock& block : blocks) fill(w, batch, block);
    contactKernels().prepare(blocks.data(), to - from, batch.masses.data(), friction);
    if (isDeep(batch, blocks)) someDeep = true;
  });
  noteSliding(batch);
  if (batch.inLanes()) giveLanes(w, batch);
  batch.isDeep = someDeep;
  if (batch.isDeep) noteDeep(batch);
}

// Multipliers from the lanes to the contacts that are kept.
void SmallSteps::Impl::takeOver(Model& w, Batch& batch) {
  physics::takeOver(batch.softRows, batch.soft);
  forEachGroup(w, batch, [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      for (int l = 0; l < ContactBlock::kLanes; ++l) takeOver(w, batch.blocks[i], l, w.settings.dt);
    }
  });
}

// Of a step that took `whole`. What it carried before is the average of as long as a step of the
// world's takes: an impact that short steps are made for lasts for several of these.
void SmallSteps::Impl::takeOver(const Model& w, const ContactBlock& block, int l, double whole) {
  if (block.contact[l] < 0) return;
  KeptContact& c = contacts[block.contact[l]];
  const double h = lengthOf(w.bodies, c), scale = substepRatio(c, h),
               part = c.whole / w.settings.dt;
  for (int k = 0; k < c.count; ++k) {
    // One that touched when it was first seen has carried its load before.
    const bool stood = c.step == 0 && block.gap[k][l] <= 0;
    c.before[k] = stood ? whole / w.settings.dt * block.point[k].lambda[l]
                        : scale * (c.before[k] + part * (c.lambda[k] - c.before[k]));
    c.lambda[k] = block.point[k].lambda[l];
  }
  c.tangential.setZero();
  for (const auto& t : block.tangent) {
    c.tangential += double(t.lambda[l]) * Vec3(t.d[0][l], t.d[1][l], t.d[2][l]);
  }
  c.twist = block.twist[l];
  c.step = h;
  c.whole = whole;
  if (!c.isLoaded()) c.held = {};
}

// What carries less than it gives way about would stand off the surface: where a load has gone,
// what is held goes down with it, in the same parts.
void SmallSteps::Impl::holdNoMore(KeptContact& c, double carried) {
  const double held = KeptContact::sumOf(c.held);
  if (!(carried < held)) return;
  for (double& of : c.held) of *= carried / held;
}

// Substeps do not follow what springs of jointed bodies are drawn by: a hand that carries a heap
// would stand in the floor by F h^2 / m of its own mass, 17 mm under 30 figures in place of 3. What
// such a contact carries from step to step beyond the weight of the lighter body becomes what it
// gives way about, so that it comes to where the bodies just touch: the method of multipliers, by a
// share that is small beside the rate of the springs. But what still carries the same goes on:
// bodies that stood when the world began would give way by their own weight, 0.06 mm at 120
// substeps a second.
void SmallSteps::Impl::holdCarried(const Model& w, const Batch& batch, double h) {
  constexpr double kShare = 1.0 / 32, kSame = 0.99;
  const double g = gravityOf(w);
  for (const int contact : batch.contacts) {
    KeptContact& c = contacts[contact];
    if (batch.isAtOnce) {  // where it is swept again it goes on from there
      for (int k = 0; k < c.count; ++k) c.held[k] = c.stayed(k) / (h * h);
      continue;
    }
    std::array<double, Manifold::kMaxPoints> stayed{};
    double sum = 0, held = 0;
    for (int k = 0; k < c.count; ++k) {
      stayed[k] = c.stayed(k) / (h * h);
      sum += stayed[k];
      held += c.held[k];
    }
    if (!isJointed(c)) {
      holdNoMore(c, sum);
      continue;
    }
    const double weight = g / (w.bodies.inverse[c.a].m + w.bodies.inverse[c.b].m);
    const double beyond = sum > weight ? 1 - weight / sum : 0;
    for (int k = 0; k < c.count; ++k) {
      const double more = beyond * stayed[k] - c.held[k];
      if (more > 0) {
        c.held[k] += kShare * more;
      } else if (sum < kSame * held) {
        c.held[k] += more;
      }
    }
  }
}

}  // namespace physics
