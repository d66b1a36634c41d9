// Bodies in the lanes of contacts, and what an impulse does to them: a part of the kernels of
// contact_block.h.
#pragma once

#include "physics/solver/contact_block.h"
#include "physics/solver/lanes.h"

namespace physics {
namespace {

constexpr float kTiny = 1e-30f;  // in place of zero, which empty lanes would be divided by

// The place of the coupling of points i < j.
constexpr int couplingOf(int i, int j) { return i == 0 ? j - 1 : i + j; }

struct Moved {
  Lanes3 u, turn;
};
struct Since {
  Lanes3 u, turn;
  Lanes deepest;
};

// Eight bodies, as they lie, into lanes and back. What has no mass is not written: blocks that
// meet it may be swept at the same time.
inline Moved gather(const int (&slot)[8], const LaneMotion* motions) {
  Lanes rows[8];
  for (int l = 0; l < 8; ++l) rows[l] = loadAt(slot, l, motions, &LaneMotion::u);
  transpose(rows);
  return {{rows[0], rows[1], rows[2]}, {rows[3], rows[4], rows[5]}};
}
inline Since gatherSince(const int (&slot)[8], const LaneMotion* motions) {
  Lanes rows[8];
  for (int l = 0; l < 8; ++l) rows[l] = loadAt(slot, l, motions, &LaneMotion::du);
  transpose(rows);
  return {{rows[0], rows[1], rows[2]}, {rows[3], rows[4], rows[5]}, rows[6]};
}
inline void scatter(const int (&slot)[8], Lanes mass, const Moved& body, LaneMotion* motions) {
  const Lanes zero = all(0);
  Lanes rows[8] = {body.u.x, body.u.y, body.u.z, body.turn.x, body.turn.y, body.turn.z, zero, zero};
  transpose(rows);
  storeAt(slot, positive(mass), rows, motions, &LaneMotion::u);
}

template <class Row, class Body>
inline Lanes rateOf(const Row& row, Lanes along, const Body& a, const Body& b) {
  return along + dot(load(row.wA), a.turn) - dot(load(row.wB), b.turn);
}

template <class Row>
inline void turn(const Row& row, Lanes impulse, Moved& a, Moved& b) {
  a.turn = a.turn + load(row.wA) * impulse;
  b.turn = b.turn - load(row.wB) * impulse;
}

inline Moved in(Blocks blocks, const Moved& a, const Moved& b) {
  return {in(blocks, a.u, b.u), in(blocks, a.turn, b.turn)};
}

inline void push(const ContactBlock& m, const Lanes3& impulse, Moved& a, Moved& b) {
  a.u = a.u + impulse * load(m.massA);
  b.u = b.u - impulse * load(m.massB);
}

inline void twist(const ContactBlock& m, Lanes impulse, Moved& a, Moved& b) {
  a.turn = a.turn + load(m.twistA) * impulse;
  b.turn = b.turn - load(m.twistB) * impulse;
}

// The gap of point i: `apart` is what the centres have moved along n.
inline Lanes gapOf(const ContactBlock& m, int i, Lanes apart, const Since& a, const Since& b) {
  return load(m.gap[i]) + rateOf(m.point[i], apart, a, b);
}

// What point i was given, to the rates of those that come after it: one alone has none, and on the
// loop that never runs g++ 12 fails.
template <int kCount>
inline void tellOthers(const ContactBlock& m, int i, Lanes delta, Lanes (&v)[kCount]) {
  if constexpr (kCount > 1) {
    for (int j = i + 1; j < kCount; ++j) v[j] = v[j] + load(m.coupling[couplingOf(i, j)]) * delta;
  }
}

// lambda, where it is at most nu_s limit, else nu_d limit its way.
inline Lanes onSegment(Lanes lambda, Lanes staticLimit, Lanes dynamicLimit) {
  const Lanes opposite = all(0) - lambda;
  return wherePositive(lambda - staticLimit, dynamicLimit,
                       wherePositive(opposite - staticLimit, all(0) - dynamicLimit, lambda));
}

// The part of |lambda| <= nu_s limit, else of length nu_d limit.
inline Lanes onDisc(Lanes squared, Lanes staticLimit, Lanes dynamicLimit) {
  const Lanes beyond = squared - staticLimit * staticLimit;
  if (positive(beyond) == 0) return all(1);  // nothing slides: no root to wait for
  return wherePositive(beyond, dynamicLimit / root(larger(squared, all(kTiny))), all(1));
}

// What the points carry in all, and by that how friction about their centre is held.
struct NormalLoads {
  Lanes sum = all(0), turning = all(0);
};
template <int kCount>
inline NormalLoads normalLoadsOf(const ContactBlock& m) {
  NormalLoads loads;
  for (int i = 0; i < kCount; ++i) {
    const Lanes lambda = load(m.point[i].lambda);
    loads.sum = loads.sum + lambda;
    loads.turning = loads.turning + load(m.point[i].lever) * lambda;
  }
  return loads;
}

struct FrictionLoads {
  Lanes along1, along2, twist;
};

// Of friction only what these hold. Returned: what that is less.
inline FrictionLoads holdFriction(ContactBlock& m, const NormalLoads& normal) {
  const Lanes nuS = load(m.staticFriction), nuD = load(m.dynamicFriction);
  ContactBlock::Tangent &t1 = m.tangent[0], &t2 = m.tangent[1];
  const Lanes last1 = load(t1.lambda), last2 = load(t2.lambda), twisted = load(m.twist);
  const Lanes share = onDisc(last1 * last1 + last2 * last2, nuS * normal.sum, nuD * normal.sum);
  const Lanes less1 = last1 * share - last1, less2 = last2 * share - last2;
  const Lanes kept = onSegment(twisted, nuS * normal.turning, nuD * normal.turning);
  store(t1.lambda, last1 + less1);
  store(t2.lambda, last2 + less2);
  store(m.twist, kept);
  return {less1, less2, kept - twisted};
}

}  // namespace
}  // namespace physics
