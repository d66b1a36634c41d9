// The position sweep: a part of the kernels of contact_block.h.
#pragma once

#include "physics/solver/contact_lanes.h"

namespace physics {
namespace {

// What is pushed apart slides: friction would hold it by the push, which is no load.
inline void forgetFriction(ContactBlock& m, Blocks near, Lanes deep, Moved& a, Moved& b) {
  const Lanes zero = all(0);
  const Moved lastA = a, lastB = b;
  for (ContactBlock::Tangent& t : m.tangent) {
    const Lanes lambda = load(t.lambda), back = wherePositive(deep, zero - lambda, zero);
    turn(t, back, a, b);
    push(m, load(t.d) * back, a, b);
    store(t.lambda, in(near, lambda + back, lambda));
  }
  const Lanes lambda = load(m.twist), back = wherePositive(deep, zero - lambda, zero);
  twist(m, back, a, b);
  store(m.twist, in(near, lambda + back, lambda));
  a = in(near, a, lastA);
  b = in(near, b, lastB);
}

// Friction of before gives no more than what the points carry now can hold: bodies would gain
// energy by the rest.
template <int kCount>
inline void limitFriction(ContactBlock& m, Moved& a, Moved& b) {
  const FrictionLoads less = holdFriction(m, normalLoadsOf<kCount>(m));
  const ContactBlock::Tangent &t1 = m.tangent[0], &t2 = m.tangent[1];
  turn(t1, less.along1, a, b);
  turn(t2, less.along2, a, b);
  twist(m, less.twist, a, b);
  push(m, load(t1.d) * less.along1 + load(t2.d) * less.along2, a, b);
}

// Where overlaps are, and what a substep takes back of them: lambda = -(s J u + aim) / A + (1 - s)
// lambda.
template <int kCount>
struct Depths {
  Lanes c[kCount], drawn[kCount], own = all(kTiny), near, full, share, soft;

  Depths(const ContactBlock& m, const Since& a, const Since& b, PositionSweep which)
      : near(larger(a.deepest, b.deepest)),
        full(load(m.scale) * load(m.rate)),
        soft(load(m.scale)) {
    const Lanes zero = all(0), tiny = all(kTiny), apart = dot(load(m.n), a.u - b.u);
    const Lanes gives = (all(1) - load(m.scale)) / larger(full, tiny);
    for (int i = 0; i < kCount; ++i) {
      c[i] = gapOf(m, i, apart, a, b);
      drawn[i] = which.isDrawnByLoad
                     ? gives * load(m.point[i].lambda) / larger(load(m.point[i].inverse), tiny)
                     : load(m.drawn[i]);
      own = larger(own, zero - (c[i] + drawn[i]));
    }
    share = smaller(full, load(m.push) / larger(own, near));
  }
  Lanes scale(int i) const { return wherePositive(c[i], all(1), soft); }
  Lanes aim(int i) const {
    return wherePositive(c[i], c[i], share * (c[i] + drawn[i]) - full * drawn[i]);
  }
};

template <int kCount>
inline void sweepPositionsBlock(ContactBlock& m, LaneMotion* motions, PositionSweep which) {
  const Depths<kCount> depths(m, gatherSince(m.bodyA, motions), gatherSince(m.bodyB, motions),
                              which);
  const Blocks near = blocksWith(depths.near);
  if (which.onlyDeep && !near.any()) return;
  Moved a = gather(m.bodyA, motions), b = gather(m.bodyB, motions);
  const Moved lastA = a, lastB = b;
  if (near.any() && !which.onlyDeep) {
    const Lanes deep = depths.full * depths.own - load(m.push);
    forgetFriction(m, near, wherePositive(depths.near, deep, all(0)), a, b);
  }
  const Lanes3 n = load(m.n);
  const Lanes zero = all(0), one = all(1), along = dot(n, a.u - b.u);
  Lanes v[kCount], lambda[kCount], sum = zero;
  for (int i = 0; i < kCount; ++i) {
    v[i] = rateOf(m.point[i], along, a, b);
    lambda[i] = load(m.point[i].lambda);
  }
  // Twice: the first point of a sweep is pushed for all, and the bodies would tilt.
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < kCount; ++i) {
      const Lanes scale = depths.scale(i), inverse = load(m.point[i].inverse);
      const Lanes yields = (one - scale) * lambda[i];
      Lanes total = larger(lambda[i] - yields - inverse * (scale * v[i] + depths.aim(i)), zero);
      if (which.onlyDeep) total = wherePositive(depths.near, total, lambda[i]);
      const Lanes delta = total - lambda[i];
      lambda[i] = total;
      for (int j = 0; j < i; ++j) v[j] = v[j] + load(m.coupling[couplingOf(j, i)]) * delta;
      tellOthers(m, i, delta, v);
      v[i] = v[i] + wherePositive(inverse, delta / larger(inverse, all(kTiny)), zero);
    }
  }
  for (int i = 0; i < kCount; ++i) {
    const Lanes delta = lambda[i] - load(m.point[i].lambda);
    store(m.point[i].lambda, lambda[i]);
    turn(m.point[i], delta, a, b);
    sum = sum + delta;
  }
  push(m, n * sum, a, b);
  if (which.onlyDeep) {
    a = in(near, a, lastA);
    b = in(near, b, lastB);
  } else {
    limitFriction<kCount>(m, a, b);
  }
  scatter(m.bodyA, load(m.massA), a, motions);
  scatter(m.bodyB, load(m.massB), b, motions);
}

template <int kCount>
inline void aimBlock(const ContactBlock& m, const LaneMotion* motions, PositionSweep which,
                     PositionAims& to) {
  const Depths<kCount> depths(m, gatherSince(m.bodyA, motions), gatherSince(m.bodyB, motions),
                              which);
  for (int i = 0; i < kCount; ++i) {
    store(to.aim[i], depths.aim(i));
    store(to.scale[i], depths.scale(i));
  }
}

}  // namespace
}  // namespace physics
