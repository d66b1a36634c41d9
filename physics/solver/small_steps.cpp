// The default method.
#include "physics/solver/small_steps.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "physics/effects/free_motion.h"
#include "physics/islands.h"
#include "physics/not_finite.h"
#include "physics/probe.h"
#include "physics/solver/articulation.h"
#include "physics/solver/contact_block.h"
#include "physics/world_impl.h"

namespace physics {
namespace {

// A contact is a spring of this many periods in a substep: above a quarter the energy of stacks
// rises, below it substeps are wasted; and its damping ratio. Against what cannot move it is twice
// as stiff.
constexpr double kPeriods = 0.25, kDamping = 2;
constexpr double kLargestSag = 1.25e-4;  // of the smaller body, on the average of the load
constexpr int kMostSubsteps = 64;
constexpr double kRest =
    1e-6;  // what a velocity sweep still changes, of an island's energy in g h^2
constexpr int kMostSweeps = 8, kMostJointedSweeps = 2;  // joints are solved again in each

Softness softness(double periods, double zeta) {
  const double omega = 2 * kPi * periods;  // omega h
  const double d = 1 + omega * (2 * zeta + omega);
  return {static_cast<float>(1 - 1 / d), static_cast<float>(omega / (2 * zeta + omega))};
}

}  // namespace

// Islands of equal substeps and sweeps, which step side by side.
struct SmallSteps::Batch {
  int substeps = 1, sweeps = 1;
  std::vector<BodyId> bodies;
  std::vector<int> contacts, articulations;
  std::vector<ContactBlock> blocks;
  std::vector<LaneMotion> motions;  // by slot; 0 is what does not move
  std::vector<LaneMass> masses;
  std::vector<BodyId> slots;  // the body of each slot
};

void SmallSteps::clear(Batch& batch) {
  batch.bodies.clear();
  batch.contacts.clear();
  batch.articulations.clear();
  batch.blocks.clear();
  batch.motions.clear();
  batch.masses.clear();
  batch.slots.clear();
}

struct SmallSteps::Impl {
  std::vector<KeptContact> contacts, before;
  std::vector<Articulation> articulations;
  std::vector<int> articulationOf;    // by body, -1: none
  bool known = false;                 // articulations are those of the world's constraints
  std::vector<int> substeps, sweeps;  // by body: of the last step, and what the next one asks for
  std::vector<int> asked, askedSweeps;
  std::vector<Batch> batches;
  std::size_t batchCount = 0;
  Islands islands;
  std::vector<int> batchOf, slotOf;                  // by body
  std::vector<std::uint64_t> colours, coloursFixed;  // by body: taken by its contacts
  std::vector<std::vector<int>> byColour;
  std::vector<JointMass> masses;
  std::vector<Displacement> moved;
  std::vector<Mat3> stiffness;
  std::vector<double> load, sag, energy, change;  // by body (of islands by their first)

  void learn(World::Impl& w);
  void makeRoom(std::size_t bodies);
  bool look(World::Impl& w, double dt);
  bool closesBy(const World::Impl& w, double dt, double far);
  void divide(World::Impl& w);
  Batch& batchFor(int substeps, int sweeps);
  void layOut(World::Impl& w, Batch& batch);
  void predict(World::Impl& w, Batch& batch, double h);
  void toLanes(Batch& batch);
  void fromLanes(Batch& batch);
  void displaceAll(World::Impl& w, Batch& batch, double h);
  void substep(World::Impl& w, Batch& batch, double h, StepReport& report);
  void takeOver(Batch& batch, double h);
  void ask(World::Impl& w, Batch& batch, double h);
  void fly(World::Impl& w, double dt);
  void advance(World::Impl& w, StepReport& report);
  void learnLoads(World::Impl& w);
  bool fresh = true;  // nothing has stepped yet, or the state came from elsewhere
  void rows(World::Impl& w, Batch& batch, double h);
  std::vector<BodyId> free;
  std::vector<Displacement> lanesBefore;
};

SmallSteps::SmallSteps() : impl_(std::make_unique<Impl>()) {}
SmallSteps::~SmallSteps() = default;
SmallSteps::SmallSteps(SmallSteps&&) noexcept = default;
SmallSteps& SmallSteps::operator=(SmallSteps&&) noexcept = default;

std::vector<KeptContact>& SmallSteps::contacts() { return impl_->contacts; }
const std::vector<KeptContact>& SmallSteps::contacts() const { return impl_->contacts; }
void SmallSteps::topologyChanged() { impl_->known = false; }
int SmallSteps::substepsOf(BodyId body) const {
  return body < static_cast<BodyId>(impl_->substeps.size()) ? impl_->substeps[body] : 1;
}
void SmallSteps::forget() {
  impl_->contacts.clear();
  sleeping.clear();
  impl_->known = false;
  impl_->fresh = true;
  std::fill(impl_->asked.begin(), impl_->asked.end(), 0);
  std::fill(impl_->askedSweeps.begin(), impl_->askedSweeps.end(), 1);
}

std::size_t SmallSteps::bytes() const {
  std::size_t sum = (impl_->contacts.capacity() + impl_->before.capacity()) * sizeof(KeptContact);
  for (const Batch& batch : impl_->batches) {
    sum += batch.blocks.capacity() * sizeof(ContactBlock) +
           batch.motions.capacity() * sizeof(LaneMotion);
  }
  return sum;
}

bool takesSmallSteps(const World::Impl& w) {
  const bool bounces = w.settings.contact && w.settings.contact->restitution > 0;
  bool takes = w.settings.method == Method::kSmallSteps &&
               w.settings.stepping == Stepping::kPaper && w.softCollider.empty() && !bounces;
  forEachKind(w.kinds, [&](const auto& kind) {
    using C = typename std::decay_t<decltype(kind)>::Item;
    if constexpr (C::kBodies == kMany || C::kBodies > 2) takes = takes && kind.set.items.empty();
  });
  return takes;
}

void SmallSteps::Impl::makeRoom(std::size_t bodies) {
  substeps.resize(bodies, 1);
  sweeps.resize(bodies, 1);
  asked.resize(bodies, 0);
  askedSweeps.resize(bodies, 1);
  batchOf.resize(bodies);
  slotOf.resize(bodies);
  colours.resize(bodies);
  coloursFixed.resize(bodies);
  masses.resize(bodies);
  moved.resize(bodies);
  lanesBefore.resize(bodies);
  stiffness.resize(bodies, Mat3::Zero());
  load.resize(bodies);
  sag.resize(bodies);
  energy.resize(bodies);
  change.resize(bodies);
}

// Bodies that constraints join make an articulation.
void SmallSteps::Impl::learn(World::Impl& w) {
  makeRoom(w.bodies.pose.size());
  if (known && articulationOf.size() == w.bodies.pose.size()) return;
  known = true;
  const Islands& joined = jointIslands(w);
  std::vector<std::vector<Articulation::Ref>> rows(joined.size());
  std::vector<BodyId> roots;
  int place = 0;
  forEachKind(w.kinds, [&](const auto& kind) {
    for (std::size_t k = 0; k < kind.set.items.size(); ++k) {
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
  articulationOf.assign(w.bodies.pose.size(), -1);
  for (const BodyId root : roots) {
    for (const BodyId body :
         articulations.emplace_back(rows[root], w.kinds, w.bodies.inverse).bodies()) {
      articulationOf[body] = static_cast<int>(articulations.size()) - 1;
    }
  }
}

// Contacts from the present poses to where the bodies would be after dt. False: the look met bodies
// that sleep, which are awake now.
bool SmallSteps::Impl::look(World::Impl& w, double dt) {
  if (!w.touches) return true;
  Bodies& b = w.bodies;
  const Vec3 fall = w.settings.gravity ? Vec3(dt * dt * *w.settings.gravity) : Vec3::Zero().eval();
  for (const BodyId i : b.active) {
    w.ahead[i] = b.pose[i];
    if (b.motion[i] == Motion::kDynamic) w.ahead[i].x += fall;
    displace(w.ahead[i], dt * b.velocity[i].v, dt * b.velocity[i].w);
  }
  const auto found = w.collider.find(b.pose, w.ahead, w.settings.contact->margin);
  if (w.sleep.count > 0) {
    const std::size_t called = w.sleep.called.size();
    for (const Manifold& m : found) {
      for (const BodyId i : {m.a, m.b}) callAwake(w, i);
    }
    if (w.sleep.called.size() > called) {
      wakeCalled(w);
      return false;
    }
  }
  std::swap(contacts, before);
  keep(before, found, b, contacts);
  return true;
}

// True where two bodies of a contact come closer in dt by more than `far` [m].
bool SmallSteps::Impl::closesBy(const World::Impl& w, double dt, double far) {
  const Bodies& b = w.bodies;
  const auto speed = [&](BodyId i) {  // of any point of it, at the most
    return b.velocity[i].v.norm() + boundingRadius(b.shape[i]) * b.velocity[i].w.norm();
  };
  for (const BodyId i : b.active) load[i] = speed(i);
  const auto known = [&](BodyId i) { return isMovable(b, i) ? load[i] : 0.0; };
  for (const KeptContact& c : contacts) {
    if (dt * (known(c.a) + known(c.b)) <= far) continue;
    const Velocity &va = b.velocity[c.a], &vb = b.velocity[c.b];
    const Vec3 n = normalOf(c, b.pose);
    for (int k = 0; k < c.count; ++k) {
      const Vec3 armA = b.pose[c.a].q * c.points[k].coreA;
      const Vec3 armB = b.pose[c.b].q * c.points[k].coreB;
      if (-dt * n.dot(va.v + va.w.cross(armA) - vb.v - vb.w.cross(armB)) > far) return true;
    }
  }
  return false;
}

SmallSteps::Batch& SmallSteps::Impl::batchFor(int count, int sweepCount) {
  for (std::size_t k = 0; k < batchCount; ++k) {
    if (batches[k].substeps == count && batches[k].sweeps == sweepCount) return batches[k];
  }
  if (batchCount == batches.size()) batches.emplace_back();
  Batch& batch = batches[batchCount++];
  clear(batch);
  batch.substeps = count;
  batch.sweeps = sweepCount;
  return batch;
}

// Islands by constraints and contacts, and the batch that each steps with.
void SmallSteps::Impl::divide(World::Impl& w) {
  const Bodies& b = w.bodies;
  islands = jointIslands(w);
  for (const KeptContact& c : contacts) join(b, islands, c.a, c.b);
  settle(islands, b.active);
  for (const BodyId i : b.active) {
    batchOf[i] = -1;
    energy[i] = 0;  // bodies of the island that something holds
    substeps[i] = std::max(1, w.settings.substeps);
    sweeps[i] = 1;
  }
  for (const BodyId i : b.active) {
    const BodyId root = islands[i];
    substeps[root] = std::max(substeps[root], asked[i]);
    sweeps[root] = std::max(sweeps[root], askedSweeps[i]);
    if (articulationOf[i] >= 0) energy[root] = 1;
  }
  for (const KeptContact& c : contacts) {
    energy[islands[isMovable(b, c.a) ? c.a : c.b]] = 1;
  }
  batchCount = 0;
  free.clear();
  for (const BodyId i : b.active) {
    const BodyId root = islands[i];
    if (energy[root] == 0) {
      free.push_back(i);
      continue;
    }
    if (batchOf[root] < 0) {
      batchOf[root] = static_cast<int>(&batchFor(substeps[root], sweeps[root]) - batches.data());
    }
    batchOf[i] = batchOf[root];
    substeps[i] = substeps[root];
    batches[batchOf[i]].bodies.push_back(i);
    const int articulation = articulationOf[i];
    if (articulation >= 0 && articulations[articulation].bodies().front() == i) {
      batches[batchOf[i]].articulations.push_back(articulation);
    }
  }
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const BodyId body = isMovable(b, contacts[k].a) ? contacts[k].a : contacts[k].b;
    batches[batchOf[body]].contacts.push_back(static_cast<int>(k));
  }
}

// Contacts of one colour share no body that moves. First those of two bodies that move, then those
// with what does not, so that a sweep ends with nothing driven into a wall. A body with more
// contacts than there are colours has the others one by one.
void SmallSteps::Impl::layOut(World::Impl& w, Batch& batch) {
  constexpr int kColours = 64, kLists = 2 * kColours;
  const Bodies& b = w.bodies;
  batch.slots.assign(1, kWorldBody);
  if (batch.contacts.empty()) return;
  for (const BodyId i : batch.bodies) {
    slotOf[i] = static_cast<int>(batch.slots.size());
    batch.slots.push_back(i);
    colours[i] = coloursFixed[i] = 0;
  }
  batch.motions.assign(batch.slots.size(), LaneMotion{});
  batch.masses.assign(batch.slots.size(), LaneMass{});
  byColour.resize(kLists);
  for (auto& list : byColour) list.clear();
  for (const int k : batch.contacts) {
    const KeptContact& c = contacts[k];
    const bool movesA = b.inverse[c.a].m > 0, movesB = b.inverse[c.b].m > 0;
    auto& used = movesA && movesB ? colours : coloursFixed;
    const std::uint64_t taken = (movesA ? used[c.a] : 0) | (movesB ? used[c.b] : 0);
    int colour = kColours - 1;
    if (~taken != 0) colour = std::min(__builtin_ctzll(~taken), kColours - 1);
    if (movesA) used[c.a] |= std::uint64_t{1} << colour;
    if (movesB) used[c.b] |= std::uint64_t{1} << colour;
    byColour[colour + (movesA && movesB ? 0 : kColours)].push_back(k);
  }
  batch.blocks.clear();
  for (int list = 0; list < kLists; ++list) {
    const bool oneByOne = list % kColours == kColours - 1;
    const std::size_t width = oneByOne ? 1 : ContactBlock::kLanes;
    for (std::size_t i = 0; i < byColour[list].size(); i += width) {
      ContactBlock& block = batch.blocks.emplace_back();
      for (std::size_t l = 0; l < ContactBlock::kLanes; ++l) {
        const bool exists = l < width && i + l < byColour[list].size();
        block.contact[l] = exists ? byColour[list][i + l] : -1;
      }
    }
  }
}

namespace {

void put(float (&to)[3][8], int l, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[k][l] = static_cast<float>(v[k]);
}

void emptyLane(ContactBlock& block, int l) {
  block.bodyA[l] = block.bodyB[l] = 0;
  put(block.n, l, Vec3::UnitY());
  block.scale[l] = 1;
  block.rate[l] = block.staticFriction[l] = block.dynamicFriction[l] = 0;
  block.twist[l] = block.change[l] = 0;
  for (auto& t : block.tangent) t.lambda[l] = 0;
}

void emptyPoint(ContactBlock::Point& p, int l) {
  put(p.armA, l, Vec3::Zero());
  put(p.armB, l, Vec3::Zero());
  p.gap[l] = 1;
  p.lambda[l] = p.inverse[l] = 0;
}

}  // namespace

// Rows of every block at the present poses, for substeps of h.
void SmallSteps::Impl::rows(World::Impl& w, Batch& batch, double h) {
  const Bodies& b = w.bodies;
  const Softness between = softness(kPeriods, kDamping);
  const Softness against = softness(2 * kPeriods, kDamping / 2);
  for (std::size_t s = 1; s < batch.slots.size(); ++s) {
    const JointMass& mass = masses[batch.slots[s]];
    LaneMass& lane = batch.masses[s];
    lane.inverse = static_cast<float>(mass.inverse);
    const Mat3& m = mass.inertia;
    const double entries[6] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
    for (int k = 0; k < 6; ++k) lane.inertia[k] = static_cast<float>(entries[k]);
    LaneMotion& motion = batch.motions[s];
    for (int k = 0; k < 3; ++k) motion.du[k] = motion.dtheta[k] = 0;
  }
  for (ContactBlock& block : batch.blocks) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) {
        emptyLane(block, l);
        for (auto& p : block.point) emptyPoint(p, l);
        continue;
      }
      const KeptContact& c = contacts[block.contact[l]];
      const Pose &a = b.pose[c.a], &o = b.pose[c.b];
      const Vec3 n = normalOf(c, b.pose);
      const Mat3 rotationA = a.q.toRotationMatrix(), rotationB = o.q.toRotationMatrix();
      const Vec3 apart = a.x - o.x;
      const double scale = c.step > 0 ? (h / c.step) * (h / c.step) : 0;
      put(block.n, l, n);
      block.bodyA[l] = isMovable(b, c.a) ? slotOf[c.a] : 0;
      block.bodyB[l] = isMovable(b, c.b) ? slotOf[c.b] : 0;
      const bool bothMove = b.inverse[c.a].m > 0 && b.inverse[c.b].m > 0;
      const Softness& soft = bothMove ? between : against;
      block.scale[l] = soft.scale;
      block.rate[l] = soft.rate;
      block.staticFriction[l] = static_cast<float>(c.friction.staticCoefficient);
      block.dynamicFriction[l] = static_cast<float>(c.friction.dynamicCoefficient);
      block.twist[l] = static_cast<float>(scale * c.twist);
      block.tangent[0].lambda[l] = static_cast<float>(scale * c.tangential.x());
      block.tangent[1].lambda[l] = static_cast<float>(scale * c.tangential.y());
      block.change[l] = static_cast<float>(scale * c.tangential.z());
      for (int k = 0; k < ContactBlock::kPoints; ++k) {
        ContactBlock::Point& p = block.point[k];
        if (k >= c.count) {
          emptyPoint(p, l);
          continue;
        }
        const ContactPoint& shape = c.points[k];
        const Vec3 onA = rotationA * shape.coreA - shape.radiusA * n;  // from a's centre
        const Vec3 onB = rotationB * shape.coreB + shape.radiusB * n;  // from b's
        const Vec3 gap = apart + onA - onB, half = 0.5 * gap;
        put(p.armA, l, onA - half);
        put(p.armB, l, onB + half);
        p.gap[l] = static_cast<float>(gap.dot(n));
        p.lambda[l] = static_cast<float>(scale * c.lambda[k]);
        p.inverse[l] = 1;
      }
    }
  }
  contactKernels().prepare(batch.blocks.data(), static_cast<int>(batch.blocks.size()),
                           batch.masses.data(), static_cast<float>(w.settings.contact->margin));
}

namespace {

// omega and half a substep on, by I^-1 (-omega x I omega).
Vec3 meanSpin(const Mat3& inertia, const Mat3& inverse, const Vec3& omega, double h) {
  return omega - 0.5 * h * (inverse * omega.cross(inertia * omega));
}

Mat3 worldInertia(const Pose& pose, const Vec3& principal) {
  const Mat3 r = pose.q.toRotationMatrix();
  return r * principal.asDiagonal() * r.transpose();
}

}  // namespace

// u = h v + h^2 M^-1 f, with the inertia at X^t and, where joints pull, their geometric stiffness.
void SmallSteps::Impl::predict(World::Impl& w, Batch& batch, double h) {
  Bodies& b = w.bodies;
  for (const int k : batch.articulations) {
    for (const BodyId i : articulations[k].bodies()) stiffness[i].setZero();
    articulations[k].stiffen(b.pose, stiffness);
  }
  for (const BodyId i : batch.bodies) {
    Displacement& m = moved[i];
    Velocity& v = b.velocity[i];
    b.start[i] = b.pose[i];
    if (b.motion[i] != Motion::kDynamic) {
      m = {h * v.v, h * v.w};
      masses[i] = {};
      continue;
    }
    if (w.settings.gravity) v.v += h * *w.settings.gravity;
    v.v += h * b.inverse[i].m * w.loads[i].force;
    m.u = h * v.v;
    masses[i].inverse = b.inverse[i].m;
    if (b.inverseInertia[i].isZero(0)) {
      m.theta = h * v.w;
      masses[i].inertia.setZero();
      continue;
    }
    const bool isRound = isIsotropic(b.inertia[i]);
    const Mat3 inverse = isRound ? Mat3(b.inverseInertia[i].x() * Mat3::Identity())
                                 : worldInertia(b.pose[i], b.inverseInertia[i]);
    v.w += h * (inverse * w.loads[i].torque);
    masses[i].inertia = inverse;
    Vec3 omega = v.w;
    if (isRound && (articulationOf[i] < 0 || stiffness[i].isZero(0))) {
      m.theta = h * omega;
      continue;
    }
    const Mat3 inertia =
        isRound ? Mat3(b.inertia[i].x() * Mat3::Identity()) : worldInertia(b.pose[i], b.inertia[i]);
    if (!isRound) omega = meanSpin(inertia, inverse, omega, h);
    m.theta = h * omega;
    if (articulationOf[i] >= 0 && !stiffness[i].isZero(0)) {
      masses[i].inertia = (inertia + stiffness[i]).inverse();
    }
  }
}

void SmallSteps::Impl::toLanes(Batch& batch) {
  for (std::size_t s = 1; s < batch.slots.size(); ++s) {
    LaneMotion& lane = batch.motions[s];
    const Displacement& m = moved[batch.slots[s]];
    for (int k = 0; k < 3; ++k) {
      lane.u[k] = static_cast<float>(m.u[k]);
      lane.theta[k] = static_cast<float>(m.theta[k]);
    }
    lanesBefore[batch.slots[s]].u = {lane.u[0], lane.u[1], lane.u[2]};
    lanesBefore[batch.slots[s]].theta = {lane.theta[0], lane.theta[1], lane.theta[2]};
  }
}

// Only what the contacts changed: what they leave alone stays as it was, to the last bit.
void SmallSteps::Impl::fromLanes(Batch& batch) {
  for (std::size_t s = 1; s < batch.slots.size(); ++s) {
    const LaneMotion& lane = batch.motions[s];
    const BodyId i = batch.slots[s];
    moved[i].u += Vec3(lane.u[0], lane.u[1], lane.u[2]) - lanesBefore[i].u;
    moved[i].theta += Vec3(lane.theta[0], lane.theta[1], lane.theta[2]) - lanesBefore[i].theta;
  }
}

// X <- X + u. Angular momentum is kept while the inertia turns.
void SmallSteps::Impl::displaceAll(World::Impl& w, Batch& batch, double h) {
  Bodies& b = w.bodies;
  for (const BodyId i : batch.bodies) {
    Displacement& m = moved[i];
    displace(b.pose[i], m.u, m.theta);
    b.pose[i].q.normalize();
    if (b.motion[i] != Motion::kDynamic || b.inverseInertia[i].isZero(0)) continue;
    if (isIsotropic(b.inertia[i])) {
      if (articulationOf[i] >= 0) {
        masses[i].inertia = b.inverseInertia[i].x() * Mat3::Identity();
      }
      continue;
    }
    const Mat3 inertia = worldInertia(b.start[i], b.inertia[i]);
    const Mat3 inverse = worldInertia(b.start[i], b.inverseInertia[i]);
    const Vec3 given = m.theta - h * meanSpin(inertia, inverse, b.velocity[i].w, h);
    const Vec3 momentum = inertia * (h * b.velocity[i].w + given);
    masses[i].inertia = worldInertia(b.pose[i], b.inverseInertia[i]);
    m.theta = masses[i].inertia * momentum;
  }
  for (std::size_t s = 1; s < batch.slots.size(); ++s) {
    LaneMotion& lane = batch.motions[s];
    for (int k = 0; k < 3; ++k) {
      lane.du[k] += lane.u[k];
      lane.dtheta[k] += lane.theta[k];
    }
  }
}

void SmallSteps::Impl::substep(World::Impl& w, Batch& batch, double h, StepReport& report) {
  Bodies& b = w.bodies;
  const ContactKernels& kernels = contactKernels();
  ContactBlock* blocks = batch.blocks.data();
  const int count = static_cast<int>(batch.blocks.size());
  const auto joints = [&](bool first) {
    for (const int k : batch.articulations) {
      for (const BodyId i : articulations[k].bodies()) {
        b.pose[i] = b.start[i];
        displace(b.pose[i], moved[i].u, moved[i].theta);
      }
      articulations[k].solvePositions(w.kinds, {b.pose, b.start, h}, first, masses, moved);
    }
  };
  turnTo("direct");
  for (const int k : batch.articulations) {
    if (!w.settings.maxCorrectionSpeed) break;
    articulations[k].leave(w.kinds, {b.pose, b.start, h}, h * *w.settings.maxCorrectionSpeed);
  }
  joints(true);
  if (count > 0) {
    turnTo("contact");
    toLanes(batch);
    kernels.warmStart(blocks, count, batch.motions.data());
    const double push = w.settings.contact->maxSeparationSpeed * h;
    kernels.sweepPositions(blocks, count, batch.motions.data(), static_cast<float>(push));
    fromLanes(batch);
  }
  turnTo("direct");
  joints(false);
  if (count == 0) joints(false);  // as smooth as this, another step of Newton's costs little
  for (const int k : batch.articulations) {
    for (const BodyId i : articulations[k].bodies()) b.pose[i] = b.start[i];
  }
  if (count > 0 && !batch.articulations.empty()) toLanes(batch);
  turnTo("motion");
  displaceAll(w, batch, h);
  turnTo("direct");
  for (const int k : batch.articulations) {
    articulations[k].prepareVelocities(w.kinds, {b.pose, b.start, h}, masses);
    articulations[k].solveVelocities(masses, moved);
  }
  if (count > 0) {
    turnTo("contact");
    toLanes(batch);
    kernels.measure(blocks, count, batch.motions.data());
    for (int s = 0; s < batch.sweeps; ++s) {
      kernels.sweepVelocities(blocks, count, batch.motions.data());
      if (batch.articulations.empty()) continue;
      fromLanes(batch);
      turnTo("direct");
      for (const int k : batch.articulations) articulations[k].solveVelocities(masses, moved);
      turnTo("contact");
      if (s + 1 < batch.sweeps) toLanes(batch);
    }
    if (batch.articulations.empty()) fromLanes(batch);
  }
  turnTo("motion");
  for (const BodyId i : batch.bodies) {
    if (b.motion[i] != Motion::kDynamic) continue;
    b.velocity[i].v = moved[i].u / h;
    b.velocity[i].w = moved[i].theta / h;
  }
  turnTo("");
  report.iterations += 1 + batch.sweeps;
  report.work.contactVisits +=
      static_cast<std::int64_t>(batch.contacts.size()) * (1 + batch.sweeps);
  report.work.frictionRows += static_cast<std::int64_t>(batch.contacts.size()) * batch.sweeps;
  for (const int k : batch.articulations) {
    report.constraintEvaluations += 3 * static_cast<std::int64_t>(articulations[k].size());
  }
  report.constraintEvaluations +=
      static_cast<std::int64_t>(batch.contacts.size()) * (1 + batch.sweeps);
}

// Multipliers from the lanes to the contacts that are kept.
void SmallSteps::Impl::takeOver(Batch& batch, double h) {
  for (const ContactBlock& block : batch.blocks) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      KeptContact& c = contacts[block.contact[l]];
      const double scale = c.step > 0 ? (h / c.step) * (h / c.step) : 0;
      for (int k = 0; k < c.count; ++k) {
        // One that touched when it was first seen has carried its load before.
        const bool stood = c.step == 0 && block.point[k].gap[l] <= 0;
        c.before[k] = stood ? block.point[k].lambda[l] : scale * c.lambda[k];
        c.lambda[k] = block.point[k].lambda[l];
      }
      c.tangential.setZero();
      for (const auto& t : block.tangent) {
        c.tangential += double(t.lambda[l]) * Vec3(t.d[0][l], t.d[1][l], t.d[2][l]);
      }
      c.twist = block.twist[l];
      c.step = h;
    }
  }
}

// How many substeps and sweeps the next step wants: the sag of a contact under what it has carried
// for two steps goes with h^2, and what the last sweep changed tells whether an island is at rest.
void SmallSteps::Impl::ask(World::Impl& w, Batch& batch, double h) {
  const Bodies& b = w.bodies;
  const double g = w.settings.gravity ? w.settings.gravity->norm() : 0;
  for (const BodyId i : batch.bodies) {
    asked[i] = 0;
    energy[i] = change[i] = load[i] = sag[i] = 0;
  }
  for (const BodyId i : batch.bodies) {
    if (b.motion[i] != Motion::kDynamic) continue;
    energy[islands[i]] += b.mass[i] * (g * g * h * h * h * h + moved[i].u.squaredNorm());
  }
  for (const ContactBlock& block : batch.blocks) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (block.contact[l] < 0) continue;
      const KeptContact& c = contacts[block.contact[l]];
      const BodyId body = isMovable(b, c.a) ? c.a : c.b;
      change[islands[body]] += block.change[l];
      const double soft = (1 - block.scale[l]) / (block.scale[l] * block.rate[l]);
      const bool jointed = articulationOf[c.a] >= 0 || articulationOf[c.b] >= 0;
      const double size = std::min(boundingRadius(b.shape[c.a]), boundingRadius(b.shape[c.b]));
      for (int k = 0; k < c.count; ++k) {
        const double inverse = block.point[k].inverse[l],
                     lambda = std::min(c.lambda[k], c.before[k]);
        if (!(inverse > 0) || !(size > 0) || jointed) continue;
        load[islands[body]] += lambda;
        sag[islands[body]] += lambda * soft * lambda / inverse / size;
      }
    }
  }
  for (const BodyId i : batch.bodies) {
    const BodyId root = islands[i];
    if (load[root] > 0) {
      const double wanted =
          std::ceil(batch.substeps * std::sqrt(sag[root] / load[root] / kLargestSag));
      asked[i] = static_cast<int>(std::min<double>(wanted, kMostSubsteps));
    }
    const double relative = energy[root] > 0 ? change[root] / energy[root] : 0;
    askedSweeps[i] = batch.sweeps;
    const int most = batch.articulations.empty() ? kMostSweeps : kMostJointedSweeps;
    if (relative > kRest) askedSweeps[i] = std::min(most, batch.sweeps + 1);
    if (relative < 0.1 * kRest) askedSweeps[i] = std::max(1, batch.sweeps - 1);
  }
}

// Bodies that nothing holds.
void SmallSteps::Impl::fly(World::Impl& w, double dt) {
  Bodies& b = w.bodies;
  for (const BodyId i : free) {
    Velocity& v = b.velocity[i];
    b.start[i] = b.pose[i];
    Vec3 gain = Vec3::Zero();
    if (b.motion[i] == Motion::kDynamic) {
      if (w.settings.gravity) gain = dt * *w.settings.gravity;
      gain += dt * b.inverse[i].m * w.loads[i].force;
    }
    b.pose[i].x += dt * (v.v + 0.5 * gain);
    v.v += gain;
    if (b.inverseInertia[i].isZero(0) || isIsotropic(b.inertia[i])) {
      v.w += dt * b.inverseInertia[i].x() * w.loads[i].torque;
      if (!v.w.isZero(0)) b.pose[i].q = (exponential(dt * v.w) * b.pose[i].q).normalized();
      continue;
    }
    const Mat3 r = b.pose[i].q.toRotationMatrix();
    Vec3 omega = r.transpose() * v.w;
    omega += dt * b.inverseInertia[i].cwiseProduct(r.transpose() * w.loads[i].torque);
    const FreeTurn turn = freeTurn(b.inertia[i], omega, dt);
    const Vec3 theta = dt * (r * turn.mean);
    v.w = exponential(theta) * (r * turn.after);
    b.pose[i].q = (exponential(theta) * b.pose[i].q).normalized();
  }
}

void SmallSteps::Impl::advance(World::Impl& w, StepReport& report) {
  const double dt = w.settings.dt;
  while (!look(w, dt)) {
  }
  // Where pairs come closer by more than they are watched within, contacts are looked for twice.
  const bool isFast =
      w.touches && w.settings.substeps > 1 && closesBy(w, dt, w.settings.contact->margin);
  const int looks = isFast ? 2 : 1;
  for (int part = 0; part < looks; ++part) {
    if (part > 0) {
      while (!look(w, dt / looks)) {
      }
    }
    divide(w);
    fly(w, dt / looks);
    report.work.moves += static_cast<std::int64_t>(free.size());
    for (std::size_t k = 0; k < batchCount; ++k) {
      Batch& batch = batches[k];
      const int count = (batch.substeps + looks - 1) / looks;
      const double h = dt / looks / count;
      report.substeps = std::max(report.substeps, looks * count);
      layOut(w, batch);
      for (int i = 0; i < count; ++i) {
        predict(w, batch, h);
        if (i == 0 && !batch.blocks.empty()) rows(w, batch, h);
        substep(w, batch, h, report);
      }
      takeOver(batch, h);
      ask(w, batch, h);
      for (const int a : batch.articulations) articulations[a].finish(w.kinds, h);
      report.work.moves += static_cast<std::int64_t>(batch.bodies.size()) * count;
    }
    checkSolved(w, report);
    if (report.notFinite) return;
  }
}

// Where nothing is known of what contacts carry, steps are trials for the one that counts, as many
// as the load needs to find its way down. Always as many: no island is to know of another.
void SmallSteps::Impl::learnLoads(World::Impl& w) {
  constexpr int kTrials = 16;
  const Bodies& b = w.bodies;
  fresh = false;
  const std::vector<Pose> pose = b.pose;
  const std::vector<Velocity> velocity = b.velocity;
  for (int trial = 0; trial < kTrials; ++trial) {
    StepReport unused;
    advance(w, unused);
    w.bodies.pose = pose;
    w.bodies.velocity = velocity;
    for (Articulation& articulation : articulations) articulation.forget();
    if (contacts.empty() || unused.notFinite) return;
  }
}

void SmallSteps::step(World::Impl& w, StepReport& report) {
  impl_->learn(w);
  if (impl_->fresh && w.touches) impl_->learnLoads(w);
  impl_->advance(w, report);
}

}  // namespace physics
