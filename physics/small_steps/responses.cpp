// Contacts that see what joints make of what they give: the articulated mass behind a body, and the
// way that its neighbours go.
#include <Eigen/Core>
#include <algorithm>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {

bool SmallSteps::Impl::meetsResponse(const KeptContact& c) const {
  const int a = articulationOf[c.a], b = articulationOf[c.b];
  return (a >= 0 && responding[a]) || (b >= 0 && responding[b]);
}

// What was touched in the last step is not in this one.
void SmallSteps::Impl::forgetResponses(Batch& batch) {
  batch.responders.clear();
  for (const int k : batch.articulations) articulations[k].response().clear();
}

// Which bodies of the articulations that respond contacts touch.
void SmallSteps::Impl::takeResponses(Batch& batch) {
  const auto responds = [&](int k) { return responding[k] != 0; };
  if (std::none_of(batch.articulations.begin(), batch.articulations.end(), responds)) return;
  batch.responders.resize(batch.slots.size());
  for (const int c : batch.contacts) {
    for (const BodyId i : {contacts[c].a, contacts[c].b}) {
      const int k = articulationOf[i];
      if (k < 0 || !responding[k]) continue;
      JointResponse& response = articulations[k].response();
      const auto all = articulations[k].allBodies();
      const int body = static_cast<int>(std::lower_bound(all.begin(), all.end(), i) - all.begin());
      if (response.placeOf(body) >= 0) continue;
      batch.responders[slotOf[i]] = {k,
                                     response.touch(body, slotOf[i], articulations[k].topology())};
    }
  }
}

namespace {

using Six = JointResponse::Six;
using SixBySix = JointResponse::SixBySix;

Six rowOf(const float (&d)[3][8], const float (&w)[3][8], int l) {
  Six j;
  j << d[0][l], d[1][l], d[2][l], w[0][l], w[1][l], w[2][l];
  return j;
}

// The rows of a lane: points, two of friction, twist; and what its bodies move by under each.
struct LaneRows {
  static constexpr int kFriction = ContactBlock::kPoints, kTwist = kFriction + 2;
  Six a[kTwist + 1], b[kTwist + 1], movedA[kTwist + 1], movedB[kTwist + 1];

  // `across`: what a moves by under impulses on b.
  LaneRows(const ContactBlock& m, int l, const SixBySix& ofA, const SixBySix& ofB,
           const SixBySix* across) {
    constexpr float kNone[3][8] = {};
    const auto set = [&](int row, const float(&d)[3][8], const float(&wA)[3][8],
                         const float(&wB)[3][8]) {
      a[row] = rowOf(d, wA, l);
      b[row] = rowOf(d, wB, l);
      movedA[row].noalias() = ofA * a[row];
      movedB[row].noalias() = ofB * b[row];
      if (!across) return;
      movedA[row].noalias() -= *across * b[row];
      movedB[row].noalias() -= across->transpose() * a[row];
    };
    for (int k = 0; k < m.points; ++k) set(k, m.n, m.point[k].wA, m.point[k].wB);
    for (int t = 0; t < 2; ++t) {
      set(kFriction + t, m.tangent[t].d, m.tangent[t].wA, m.tangent[t].wB);
    }
    set(kTwist, kNone, m.twistA, m.twistB);
  }
  // J R J^T
  double between(int r, int c) const { return a[r].dot(movedA[c]) + b[r].dot(movedB[c]); }
};

void takeRows(const LaneRows& rows, int l, ContactBlock& m) {
  constexpr int kFriction = LaneRows::kFriction, kTwist = LaneRows::kTwist;
  for (int k = 0; k < m.points; ++k) {
    float& inverse = m.point[k].inverse[l];
    if (!(inverse > 0)) continue;
    const auto seen = static_cast<float>(1 / rows.between(k, k));
    const float drawn = m.drawn[k][l] * (inverse / seen);  // by `held`, as stiff as that
    m.gap[k][l] += m.drawn[k][l] - drawn;
    m.drawn[k][l] = drawn;
    inverse = seen;
    for (int i = 0; i < k; ++i) {
      m.coupling[i == 0 ? k - 1 : i + k][l] = static_cast<float>(rows.between(i, k));
    }
  }
  const double a11 = rows.between(kFriction, kFriction),
               a22 = rows.between(kFriction + 1, kFriction + 1);
  const double a12 = rows.between(kFriction, kFriction + 1), determinant = a11 * a22 - a12 * a12;
  m.inverse11[l] = static_cast<float>(a22 / determinant);
  m.inverse12[l] = static_cast<float>(-a12 / determinant);
  m.inverse22[l] = static_cast<float>(a11 / determinant);
  if (m.twistInverse[l] > 0)
    m.twistInverse[l] = static_cast<float>(1 / rows.between(kTwist, kTwist));
  for (int t = 0; t < 2; ++t) {
    m.tangent[t].twisted[l] = static_cast<float>(rows.between(kFriction + t, kTwist));
  }
}

}  // namespace

// A = J R J^T of the rows of a lane.
void SmallSteps::Impl::prepareResponses(Batch& batch, ContactBlock& m, int l) const {
  const auto own = [&](int slot) {
    const Responder& r = batch.responders[slot];
    if (r.articulation >= 0) {
      return articulations[r.articulation].response().own(r.place);
    }
    SixBySix alone = SixBySix::Zero();
    if (slot > 0) alone.diagonal() << Vec3::Constant(batch.masses[slot].inverse), Vec3::Ones();
    return alone;
  };
  const Responder &a = batch.responders[m.bodyA[l]], &b = batch.responders[m.bodyB[l]];
  const bool isWithin = a.articulation >= 0 && a.articulation == b.articulation;
  SixBySix across;
  if (isWithin) across = articulations[a.articulation].response().between(a.place, b.place);
  const LaneRows rows(m, l, own(m.bodyA[l]), own(m.bodyB[l]), isWithin ? &across : nullptr);
  takeRows(rows, l, m);
}

// Where joints are as the stage finds them.
void SmallSteps::Impl::respond(Batch& batch) {
  if (batch.responders.empty()) return;
  for (const int k : batch.articulations) {
    JointResponse& response = articulations[k].response();
    for (int i = 0; i < static_cast<int>(response.size()); ++i) {
      response.setMass(i, batch.masses[response.slotAt(i)]);
    }
  }
  batch.joints.respond();
  for (const BlockStage& stage : batch.stages) {
    if (!stage.responds) continue;
    for (int k = batch.groups[stage.first]; k < batch.groups[stage.end]; ++k) {
      for (int l = 0; l < ContactBlock::kLanes; ++l) {
        if (batch.blocks[k].contact[l] >= 0) prepareResponses(batch, batch.blocks[k], l);
      }
    }
  }
}

// What the body of a slot moves by, where contacts have given others of its articulation something.
LaneStart SmallSteps::Impl::lookAtResponse(Batch& batch, int slot) const {
  const Responder& from = batch.responders[slot];
  const Six by = articulations[from.articulation].response().movedBy(from.place);
  const LaneStart& start = batch.before[slot];
  LaneMotion& motion = batch.motions[slot];
  LaneStart now;
  for (int k = 0; k < 3; ++k) {
    now.u[k] = motion.u[k] = static_cast<float>(start.u[k] + by[k]);
    now.turn[k] = motion.turn[k] = static_cast<float>(start.turn[k] + by[3 + k]);
  }
  return now;
}

// Of all, where sweeps have looked at those of their own blocks alone.
void SmallSteps::Impl::lookAtResponses(Batch& batch) const {
  for (std::size_t s = 1; s < batch.responders.size(); ++s) {
    if (batch.responders[s].articulation >= 0) lookAtResponse(batch, static_cast<int>(s));
  }
}

// What a sweep gave it beside that, as if it had no joints.
void SmallSteps::Impl::respondTo(const Batch& batch, int slot, const LaneStart& before) {
  const Responder& to = batch.responders[slot];
  const LaneMotion& motion = batch.motions[slot];
  const double mass = 1.0 / batch.masses[slot].inverse;
  Six given;
  for (int k = 0; k < 3; ++k) {
    given[k] = mass * (double(motion.u[k]) - before.u[k]);
    given[3 + k] = double(motion.turn[k]) - before.turn[k];
  }
  articulations[to.articulation].response().give(to.place, given);
}

}  // namespace physics
