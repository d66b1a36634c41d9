// Rows of contacts anew: where a body has turned so far that its arms and inertia are others, and
// where bodies go so far past each other that other features of them meet.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

// It turns without a change of arms and inertia.
bool isRound(const Bodies& b, BodyId i) {
  return std::holds_alternative<Sphere>(b.shape[i]) && isIsotropic(b.inertia[i]);
}

// Lane l of one block to another, which lies as eight numbers a row.
void copyLane(const ContactBlock& from, int l, ContactBlock& to) {
  constexpr std::size_t kNumber = sizeof(float), kRow = ContactBlock::kLanes * kNumber;
  const auto* source = reinterpret_cast<const unsigned char*>(&from) + l * kNumber;
  auto* target = reinterpret_cast<unsigned char*>(&to) + l * kNumber;
  for (std::size_t i = 0; i < offsetof(ContactBlock, points); i += kRow) {
    std::memcpy(target + i, source + i, kNumber);
  }
}

// What lane l carries by now, for prepare(): friction as a vector of the world.
void keepLoads(const ContactBlock& now, int l, ContactBlock& fresh) {
  float last[3] = {};
  for (const auto& t : now.tangent) {
    for (int k = 0; k < 3; ++k) last[k] += t.lambda[l] * t.d[k][l];
  }
  fresh.tangent[0].lambda[l] = last[0];
  fresh.tangent[1].lambda[l] = last[1];
  fresh.change[0][l] = last[2];
  for (int k = 0; k < now.points; ++k) fresh.point[k].lambda[l] = now.point[k].lambda[l];
}

// The part of a gap that body `side` of lane l has moved by since its rows were prepared.
float movedBy(const float (&n)[3][8], const float (&w)[3][8], int l, const LaneMotion& motion) {
  float sum = 0;
  for (int k = 0; k < 3; ++k) sum += n[k][l] * motion.du[k] + w[k][l] * motion.dturn[k];
  return sum;
}

// Gaps are measured from where each body was when its rows were prepared, and of a pair only one
// may stand there now.
void measureFromStart(const std::vector<LaneMotion>& motions, int l, ContactBlock& block) {
  const LaneMotion &a = motions[block.bodyA[l]], &b = motions[block.bodyB[l]];
  for (int k = 0; k < block.points; ++k) {
    const auto& p = block.point[k];
    block.gap[k][l] -= movedBy(block.n, p.wA, l, a) - movedBy(block.n, p.wB, l, b);
  }
}

}  // namespace

// The normal of lane l joins two centres, and they have moved past each other by an angle of `far`.
bool SmallSteps::Impl::turnsNormal(const ContactBlock& block, int l,
                                   const std::vector<LaneMotion>& motions, double far) const {
  if (block.contact[l] < 0) return false;
  const KeptContact& c = contacts[block.contact[l]];
  if (!c.radial) return false;
  const LaneMotion &a = motions[block.bodyA[l]], &b = motions[block.bodyB[l]];
  const auto motion = [](const LaneMotion& m) { return Vec3(m.du[0], m.du[1], m.du[2]); };
  const Vec3 n(block.n[0][l], block.n[1][l], block.n[2][l]);
  return n.cross(motion(a) - motion(b)).norm() > far * (c.points[0].radiusA + c.points[0].radiusB);
}

// True: some of the batch have turned far, and the rows of those are to be prepared anew. By an
// accuracy that is as far as a step may err, if it resolves the motion: what the rows of a tableau
// have in common it does not see. Then normals between centres turn as well, and what is round has
// no other.
bool SmallSteps::Impl::findTurned(Model& w, Batch& batch) const {
  const bool isAsked = stepsAccurately(w, batch) && !batch.isLost;
  const double far = isAsked ? std::min(kStraightTurn, allowedError(w)) : kStraightTurn;
  std::atomic<bool> some = false;
  batch.turned.resize(batch.motions.size());
  forEachBody(w, batch, [&](BodyId i, int s) {
    const auto& turn = batch.motions[s].dturn;
    const Vec3 theta = rotationOf(batch.masses[s], Vec3(turn[0], turn[1], turn[2]));
    batch.turned[s] = theta.squaredNorm() > far * far && !(isAsked && isRound(w.bodies, i));
    if (batch.turned[s]) some = true;
  });
  for (std::size_t i = 0; isAsked && i < batch.blocks.size(); ++i) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      if (!turnsNormal(batch.blocks[i], l, batch.motions, far)) continue;
      batch.turned[batch.blocks[i].bodyA[l]] = batch.turned[batch.blocks[i].bodyB[l]] = 1;
      some = true;
    }
  }
  batch.turned[0] = 0;  // what does not move
  return some;
}

// Lanes with a body that turned far; the others keep every byte.
void SmallSteps::Impl::renew(const Model& w, const Batch& batch, ContactBlock& block) const {
  const auto isTurned = [&](int l) {
    return block.contact[l] >= 0 && (batch.turned[block.bodyA[l]] || batch.turned[block.bodyB[l]]);
  };
  unsigned lanes = 0;
  for (int l = 0; l < ContactBlock::kLanes; ++l) lanes |= unsigned{isTurned(l)} << l;
  if (lanes == 0) return;
  ContactBlock fresh = block;
  for (int l = 0; l < ContactBlock::kLanes; ++l) {
    if (lanes >> l & 1) {
      placeLane(contacts[block.contact[l]], w.bodies.pose, stepsAccurately(w, batch), fresh, l);
      keepLoads(block, l, fresh);
    } else {
      emptyLane(fresh, l);
    }
  }
  contactKernels().prepare(&fresh, 1, batch.masses.data(), frictionAt(w, batch));
  for (int l = 0; l < ContactBlock::kLanes; ++l) {
    if (!(lanes >> l & 1)) continue;
    measureFromStart(batch.motions, l, fresh);
    copyLane(fresh, l, block);
  }
}

// The lanes whose bodies go far past each other.
void SmallSteps::Impl::noteSliding(Batch& batch) const {
  batch.sliding.clear();
  if (sliding.empty()) return;
  for (std::size_t i = 0; i < batch.blocks.size(); ++i) {
    for (int l = 0; l < ContactBlock::kLanes; ++l) {
      const int k = batch.blocks[i].contact[l];
      if (k >= 0 && sliding[k]) batch.sliding.emplace_back(static_cast<int>(i), l);
    }
  }
}

// What meets at the present poses, or will within a substep. False: it is not looked for.
bool SmallSteps::Impl::findFeatures(const Model& w, const KeptContact& c, Manifold& found) const {
  const Bodies& b = w.bodies;
  const double h = lengthOf(b, c), way = h * (b.velocity[c.a].v - b.velocity[c.b].v).norm();
  double turn = 0;
  for (const BodyId i : {c.a, c.b}) {
    if (isMovable(b, i)) turn += h * radius[i] * b.velocity[i].w.norm();
  }
  const double near = w.settings.contact->margin + way + turn;
  return w.collider.lookAt(c.key, b.pose[c.a], b.pose[c.b], near, turn, found);
}

// True: these are others for lane l. What it carried is given again where that has not turned: the
// solve takes back along its rows what it gave.
bool SmallSteps::Impl::lookAtSliding(const Model& w, ContactBlock& block, int l) {
  KeptContact& c = contacts[block.contact[l]];
  Manifold found;
  if (!findFeatures(w, c, found) || (c.count == 0 && found.count == 0)) return false;
  found.count = std::min(found.count, block.points);
  const Vec3 n = normalOf(c, w.bodies.pose);
  KeptContact now = c;
  for (int k = 0; k < c.count; ++k) now.lambda[k] = block.point[k].lambda[l];
  physics::renew(found, w.bodies, now);
  physics::renew(found, w.bodies, c);
  const bool goesOn = n.cross(normalOf(c, w.bodies.pose)).norm() < kStraightTurn;
  for (int k = 0; k < block.points; ++k) {
    block.point[k].lambda[l] = goesOn && k < c.count ? static_cast<float>(now.lambda[k]) : 0;
  }
  if (!goesOn) block.tangent[0].lambda[l] = block.tangent[1].lambda[l] = block.twist[l] = 0;
  return true;
}

// At the start of a substep.
void SmallSteps::Impl::lookAtSliding(Model& w, Batch& batch) {
  if (batch.sliding.empty() || (stepsAccurately(w, batch) && !batch.isLost)) return;
  batch.turned.assign(batch.slots.size(), 0);
  for (const auto& [i, l] : batch.sliding) {
    ContactBlock& block = batch.blocks[i];
    if (!lookAtSliding(w, block, l)) continue;
    batch.turned[block.bodyA[l]] = batch.turned[block.bodyB[l]] = 1;
  }
  batch.turned[0] = 0;  // what does not move
  renewRows(w, batch);
}

void SmallSteps::Impl::renewTurned(Model& w, Batch& batch) {
  if (batch.blocks.empty()) return;
  if (batch.inLanes() ? batch.someTurned : findTurned(w, batch)) renewRows(w, batch);
}

// Of the bodies that turned.
void SmallSteps::Impl::renewRows(Model& w, Batch& batch) {
  for (std::size_t s = 1; s < batch.slots.size(); ++s) {
    if (!batch.turned[s]) continue;
    const int slot = static_cast<int>(s);
    tellBody(batch, slot);
    batch.masses[s] = laneMassOf(masses[batch.slots[s]]);
    batch.inverses[s] = inverseOf(batch.masses[s]);
    startRows(batch.motions[s]);
    toLane(batch, slot);
    seeBody(batch, slot);
  }
  forEachGroup(w, batch, [&](int from, int to) {
    for (int i = from; i < to; ++i) renew(w, batch, batch.blocks[i]);
  });
}

}  // namespace physics
