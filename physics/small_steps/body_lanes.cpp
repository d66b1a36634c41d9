// Bodies that contacts alone hold, eight at a time: into the lanes of body_block.h and back. They
// are there for the substeps of a step; poses and velocities are everybody's after each.
#include <Eigen/Core>
#include <algorithm>
#include <atomic>

#include "physics/motion/free_motion.h"
#include "physics/small_steps/small_steps_impl.h"
#include "physics/solver/joint_lanes.h"

namespace physics {

const BodyKernels& bodyKernels() {
  static const BodyKernels& chosen = __builtin_cpu_supports("avx512f") ? kBodyKernelsAvx512
                                     : __builtin_cpu_supports("avx2")  ? kBodyKernelsAvx2
                                                                       : kBodyKernelsSse2;
  return chosen;
}

void freeSpin(const double (&inertia)[3], const double (&q)[4], double h, double (&w)[3]) {
  const Quat turn(q[0], q[1], q[2], q[3]);
  const Vec3 own = turn.conjugate() * Vec3(w[0], w[1], w[2]);
  const Vec3 mean = turn * freeTurn({inertia[0], inertia[1], inertia[2]}, own, h).mean;
  for (int k = 0; k < 3; ++k) w[k] = mean[k];
}

namespace {

Mat3 symmetricAt(const BodyBlock::Lanes* of, int l) {
  const double xy = of[3].v[l], xz = of[4].v[l], yz = of[5].v[l];
  Mat3 m;
  m << of[0].v[l], xy, xz, xy, of[1].v[l], yz, xz, yz, of[2].v[l];
  return m;
}

void seeLane(const LaneMotion& motion, BodyBlock& b, int l) {
  for (int k = 0; k < 3; ++k) {
    b.nowU[k].v[l] = motion.u[k];
    b.nowTurn[k].v[l] = motion.turn[k];
  }
}

// What contacts know is what the body knows that they do.
void tellLane(BodyBlock& b, int l, LaneMotion& motion) {
  for (int k = 0; k < 3; ++k) {
    b.knownU[k].v[l] = motion.u[k] = static_cast<float>(b.nowU[k].v[l]);
    b.knownTurn[k].v[l] = motion.turn[k] = static_cast<float>(b.nowTurn[k].v[l]);
  }
}

}  // namespace

// f(block, its number, the first and the end of its lanes), dealt to threads.
template <class F>
void SmallSteps::Impl::forEachBodyBlock(Model& w, Batch& batch, F&& f) {
  const int slots = static_cast<int>(batch.slots.size());
  w.workers.forEachChunk(static_cast<int>(batch.lanes.size()), kLeastBodies / BodyBlock::kLanes,
                         [&](int from, int to) {
                           for (int i = from; i < to; ++i) {
                             f(batch.lanes[i], i * BodyBlock::kLanes, i == 0 ? 1 : 0,
                               std::min(BodyBlock::kLanes, slots - i * BodyBlock::kLanes));
                           }
                         });
}

// At the start of a step: what stays.
void SmallSteps::Impl::startBody(const Model& w, BodyId i, BodyBlock& b, int l) const {
  const Bodies& bodies = w.bodies;
  const Inertia kind = inertiaOf[i];
  b.moves.v[l] = kind != Inertia::kGiven;
  b.isTurned.v[l] = kind == Inertia::kRound || kind == Inertia::kOther;
  b.turns.v[l] = kind == Inertia::kOther;
  b.h.v[l] = length[i];
  b.rate.v[l] = 1 / length[i];
  write(b.inertia, l, bodies.inertia[i]);
  write(b.inverseInertia, l, bodies.inverseInertia[i]);
  writeSymmetric(b.inverse, l, masses[i].inertia);
}

// Gravity and loads, and where it is.
void SmallSteps::Impl::pushBody(Model& w, BodyId i, BodyBlock& b, int l) const {
  Bodies& bodies = w.bodies;
  const Pose& pose = bodies.pose[i];
  Velocity& v = bodies.velocity[i];
  bodies.start[i] = pose;
  const double kick = length[i] * b.moves.v[l];
  if (w.settings.gravity) v.v += kick * *w.settings.gravity;
  if (!w.loaded.empty()) {
    v.v += kick * bodies.inverse[i].m * w.loads[i].force;
    v.w += kick * (symmetricAt(b.inverse, l) * w.loads[i].torque);
  }
  writeTurn(b.q, l, pose.q);
  write(b.u, l, v.v);
  write(b.w, l, v.w);
}

// Before the first substep rows are not prepared yet: contacts are told then.
void SmallSteps::Impl::predictLanes(Model& w, Batch& batch, bool first) {
  forEachBodyBlock(w, batch, [&](BodyBlock& b, int slot, int from, int to) {
    if (first && to - from < BodyBlock::kLanes) b = {};
    for (int l = from; l < to; ++l) {
      const BodyId i = batch.slots[slot + l];
      if (first) {
        takeMass(w, i);
        startBody(w, i, b, l);
      }
      pushBody(w, i, b, l);
    }
    bodyKernels().predict(b);
    if (first) return;
    bodyKernels().give(b);
    for (int l = from; l < to; ++l) tellLane(b, l, batch.motions[slot + l]);
  });
}

// Once their rows are prepared.
void SmallSteps::Impl::takeRoot(Batch& batch, int slot) {
  BodyBlock& b = batch.lanes[slot / BodyBlock::kLanes];
  for (int k = 0; k < 6; ++k) {
    b.root[k].v[slot % BodyBlock::kLanes] = batch.masses[slot].root[k];
    b.inverseRoot[k].v[slot % BodyBlock::kLanes] = batch.inverses[slot].entries[k];
  }
}

// What bodies move by before contacts have pushed.
void SmallSteps::Impl::giveLanes(Model& w, Batch& batch) {
  forEachBodyBlock(w, batch, [&](BodyBlock& b, int slot, int from, int to) {
    bodyKernels().give(b);
    for (int l = from; l < to; ++l) tellLane(b, l, batch.motions[slot + l]);
  });
}

// X <- X + u, and which have turned so far that their rows are to be prepared anew.
void SmallSteps::Impl::displaceLanes(Model& w, Batch& batch) {
  batch.turned.resize(batch.slots.size());
  std::atomic<bool> some = false;
  forEachBodyBlock(w, batch, [&](BodyBlock& b, int slot, int from, int to) {
    for (int l = from; l < to; ++l) {
      LaneMotion& motion = batch.motions[slot + l];
      seeLane(motion, b, l);
      for (int k = 0; k < 3; ++k) {
        motion.du[k] += motion.u[k];
        motion.dturn[k] += motion.turn[k];
        b.sinceRows[k].v[l] = motion.dturn[k];
      }
    }
    bodyKernels().displace(b);
    for (int l = from; l < to; ++l) {
      Pose& pose = w.bodies.pose[batch.slots[slot + l]];
      pose.x += read(b.u, l);
      pose.q = readTurn(b.q, l);
      tellLane(b, l, batch.motions[slot + l]);
      batch.turned[slot + l] = b.sinceRows[0].v[l] > kStraightTurn * kStraightTurn;
      if (batch.turned[slot + l]) some = true;
    }
  });
  batch.someTurned = some;
}

void SmallSteps::Impl::endLanes(Model& w, Batch& batch) {
  forEachBodyBlock(w, batch, [&](BodyBlock& b, int slot, int from, int to) {
    for (int l = from; l < to; ++l) seeLane(batch.motions[slot + l], b, l);
    bodyKernels().end(b);
    for (int l = from; l < to; ++l) {
      Velocity& velocity = w.bodies.velocity[batch.slots[slot + l]];
      if (b.moves.v[l] > 0) velocity = {read(b.u, l), read(b.theta, l)};
    }
  });
}

// What is only in the lanes.
void SmallSteps::Impl::tellBody(const Batch& batch, int slot) {
  if (!batch.inLanes()) return;
  const BodyBlock& b = batch.lanes[slot / BodyBlock::kLanes];
  const BodyId i = batch.slots[slot];
  const int l = slot % BodyBlock::kLanes;
  moved[i] = {read(b.u, l), read(b.theta, l)};
  masses[i].inertia = symmetricAt(b.inverse, l);
}

// Its rows are prepared anew, and contacts told again what it moves by.
void SmallSteps::Impl::seeBody(Batch& batch, int slot) {
  if (!batch.inLanes()) return;
  takeRoot(batch, slot);
  BodyBlock& b = batch.lanes[slot / BodyBlock::kLanes];
  seeLane(batch.motions[slot], b, slot % BodyBlock::kLanes);
  tellLane(b, slot % BodyBlock::kLanes, batch.motions[slot]);
}

}  // namespace physics
