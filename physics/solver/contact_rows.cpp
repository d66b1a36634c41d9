// Contacts into the lanes that sweep over them, and back.
#include <algorithm>

#include "physics/solver/small_steps_impl.h"

namespace physics {
namespace {

// A contact is a spring of this many periods in a substep: above a quarter the energy of stacks
// rises, below it substeps are wasted; and its damping ratio. Against what cannot move it is twice
// as stiff.
constexpr double kPeriods = 0.25, kDamping = 2;
// Of the load at the start, carried without sag. With all of it contacts open and shut, and stacks
// creep; with half of it pyramids take more sweeps.
constexpr double kHeld = 0.25;

Softness softness(double periods, double zeta) {
  const double omega = 2 * kPi * periods;  // omega h
  const double d = 1 + omega * (2 * zeta + omega);
  return {static_cast<float>(1 - 1 / d), static_cast<float>(omega / (2 * zeta + omega))};
}

}  // namespace

// Contacts of one colour share no body that moves. First those of two bodies that move, then those
// with what does not, so that a sweep ends with nothing driven into a wall. A body with more
// contacts than there are colours has the others one by one.
void SmallSteps::Impl::layOut(World::Impl& w, Batch& batch) {
  constexpr int kColours = 64, kLists = 2 * kColours;
  const Bodies& b = w.bodies;
  batch.slots.assign(1, kWorldBody);
  if (batch.contacts.empty()) return batch.blocks.clear();
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
  const auto widthOf = [&](int list) -> std::size_t {
    return list % kColours == kColours - 1 ? 1 : ContactBlock::kLanes;
  };
  std::size_t blocks = 0, next = 0;
  for (int list = 0; list < kLists; ++list) {
    blocks += (byColour[list].size() + widthOf(list) - 1) / widthOf(list);
  }
  batch.blocks.resize(blocks);
  for (int list = 0; list < kLists; ++list) {
    const std::size_t width = widthOf(list);
    for (std::size_t i = 0; i < byColour[list].size(); i += width) {
      ContactBlock& block = batch.blocks[next++];
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
  put(p.turnA, l, Vec3::Zero());
  put(p.turnB, l, Vec3::Zero());
  p.gap[l] = 1;
  p.lambda[l] = p.held[l] = p.inverse[l] = 0;
}

// The part of what a contact carried at the start that it carries without giving way: no more than
// of what it carries now.
double heldPart(const KeptContact& c) {
  double held = 0, carried = 0;
  for (int k = 0; k < c.count; ++k) {
    held += c.held[k];
    carried += c.lambda[k];
  }
  return held > 0 ? kHeld * std::min(1.0, carried / (c.step * c.step * held)) : 0;
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
      const double held = heldPart(c);
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
        put(p.turnA, l, onA - half);
        put(p.turnB, l, onB + half);
        p.gap[l] = static_cast<float>(gap.dot(n));
        p.lambda[l] = static_cast<float>(scale * c.lambda[k]);
        p.held[l] = static_cast<float>(h * h * held * c.held[k]);
        p.inverse[l] = 1;
      }
    }
  }
  contactKernels().prepare(batch.blocks.data(), static_cast<int>(batch.blocks.size()),
                           batch.masses.data(), static_cast<float>(w.settings.contact->margin));
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

// Rows are prepared once and hold for the substeps that follow, but where a body has turned so far
// that its arms and inertia are others.
bool SmallSteps::Impl::turnedFar(const Batch& batch) const {
  constexpr float kFar = 0.05f;  // rad
  return std::any_of(batch.motions.begin(), batch.motions.end(), [](const LaneMotion& m) {
    const float squared =
        m.dtheta[0] * m.dtheta[0] + m.dtheta[1] * m.dtheta[1] + m.dtheta[2] * m.dtheta[2];
    return squared > kFar * kFar;
  });
}

// Multipliers from the lanes to the contacts that are kept.
void SmallSteps::Impl::takeOver(Batch& batch, double h) {
  physics::takeOver(batch.softRows, batch.soft);
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

}  // namespace physics
