// The kernels of contact_block.h that sweep over blocks.
#pragma once

#include "physics/solver/contact_positions.h"

namespace physics {
namespace {

template <int kCount>
struct Count {
  static constexpr int value = kCount;
};

// What the lanes carry, to the bodies.
template <int kCount>
inline void giveBlock(const ContactBlock& m, LaneMotion* motions) {
  Moved a = gather(m.bodyA, motions), b = gather(m.bodyB, motions);
  Lanes sum = all(0);
  for (int i = 0; i < kCount; ++i) {
    const Lanes lambda = load(m.point[i].lambda);
    sum = sum + lambda;
    turn(m.point[i], lambda, a, b);
  }
  const ContactBlock::Tangent &t1 = m.tangent[0], &t2 = m.tangent[1];
  const Lanes along1 = load(t1.lambda), along2 = load(t2.lambda);
  turn(t1, along1, a, b);
  turn(t2, along2, a, b);
  twist(m, load(m.twist), a, b);
  push(m, load(m.n) * sum + load(t1.d) * along1 + load(t2.d) * along2, a, b);
  scatter(m.bodyA, load(m.massA), a, motions);
  scatter(m.bodyB, load(m.massB), b, motions);
}

// What was carried before is a load, that of an impact as well: where it has gone the sweep takes
// it back. Friction is not swept there: what an impact lent it would push and turn the bodies on.
// It is what the load can hold that has lasted for two substeps.
template <int kCount>
inline void warmStartBlock(ContactBlock& m, LaneMotion* motions) {
  const NormalLoads now = normalLoadsOf<kCount>(m);
  const Lanes lasting = smaller(now.sum, load(m.lasted));
  holdFriction(m, {lasting, now.turning * (lasting / larger(now.sum, all(kTiny)))});
  store(m.lasted, now.sum);
  giveBlock<kCount>(m, motions);
}

template <int kCount>
inline Lanes workOf(const ContactBlock& m, const LaneMotion* motions) {
  const Moved a = gather(m.bodyA, motions), b = gather(m.bodyB, motions);
  const Lanes3 between = a.u - b.u;
  const Lanes along = dot(load(m.n), between);
  Lanes sum = load(m.twist) * (dot(load(m.twistA), a.turn) - dot(load(m.twistB), b.turn));
  for (int i = 0; i < kCount; ++i) {
    sum = sum + load(m.point[i].lambda) * rateOf(m.point[i], along, a, b);
  }
  for (const ContactBlock::Tangent& t : m.tangent) {
    sum = sum + load(t.lambda) * rateOf(t, dot(load(t.d), between), a, b);
  }
  return sum;
}

// Of w = last - A^-1 v, the friction that would hold the centre, what the disc allows: where it
// slides, the least of 1/2 lambda A lambda + lambda (v - A last) on the disc, which is
//   (A + s) lambda = A w,   |lambda| = nu_d N,   s > 0: what is left of v is -s lambda
// with s by a step of Newton's for 1 / |lambda|: exact where A is the same along both, and where
// much more would be needed. Cut to the disc along w, a box that slides askew would be pushed aside
// by a sixth of its friction.
inline void takeDisc(const ContactBlock& m, Lanes staticLimit, Lanes dynamicLimit, Lanes& w1,
                     Lanes& w2) {
  constexpr float kLeast = 1e-6f;  // of w, some ten roundings: less changes no direction
  const Lanes squared = w1 * w1 + w2 * w2, beyond = squared - staticLimit * staticLimit;
  if (positive(beyond) == 0) return;  // nothing slides
  const Lanes one = all(1), tiny = all(kTiny), perLength = one / root(larger(squared, tiny));
  const Lanes limit = larger(dynamicLimit * perLength, all(kLeast));  // of w, as what follows
  const Lanes u1 = w1 * perLength, u2 = w2 * perLength;
  const Lanes a11 = load(m.inverse11), a12 = load(m.inverse12), a22 = load(m.inverse22);
  const Lanes falls = u1 * (a11 * u1 + a12 * u2) + u2 * (a12 * u1 + a22 * u2);
  const Lanes s = (one - limit) / larger(limit * falls, tiny);
  // To the disc by its length alone, so that no determinant is needed.
  const Lanes l1 = u1 + s * (a22 * u1 - a12 * u2), l2 = u2 + s * (a11 * u2 - a12 * u1);
  const Lanes scale = dynamicLimit / root(larger(l1 * l1 + l2 * l2, tiny));
  w1 = wherePositive(beyond, l1 * scale, w1);
  w2 = wherePositive(beyond, l2 * scale, w2);
}

// Twist and friction, where the points carry `normal`, and `turning` about their centre. Returned:
// the impulse of friction.
inline Lanes3 sweepFriction(ContactBlock& m, Lanes normal, Lanes turning, const Lanes3& between,
                            Moved& a, Moved& b) {
  const Lanes nuS = load(m.staticFriction), nuD = load(m.dynamicFriction);
  ContactBlock::Tangent &t1 = m.tangent[0], &t2 = m.tangent[1];
  const Lanes last1 = load(t1.lambda), last2 = load(t2.lambda), twisted = load(m.twist);
  const Lanes grip = (nuS + nuD) * normal;
  const Lanes3 none = {all(0), all(0), all(0)};
  const Blocks grips = blocksWith(grip + last1 * last1 + last2 * last2 + twisted * twisted);
  if (!grips.any()) return none;  // nor did
  const Moved lastA = a, lastB = b;
  const Lanes3 d1 = load(t1.d), d2 = load(t2.d);
  const Lanes rate = dot(load(m.twistA), a.turn) - dot(load(m.twistB), b.turn);
  const Lanes rate1 = rateOf(t1, dot(d1, between), a, b);
  const Lanes rate2 = rateOf(t2, dot(d2, between), a, b);
  const Lanes wanted = twisted - load(m.twistInverse) * rate;
  const Lanes kept = onSegment(wanted, nuS * turning, nuD * turning);
  const Lanes more = kept - twisted;
  store(m.twist, in(grips, kept, twisted));
  const Lanes v1 = rate1 + load(t1.twisted) * more, v2 = rate2 + load(t2.twisted) * more;
  const Lanes across = load(m.inverse12);
  Lanes total1 = last1 - (load(m.inverse11) * v1 + across * v2);
  Lanes total2 = last2 - (across * v1 + load(m.inverse22) * v2);
  takeDisc(m, nuS * normal, nuD * normal, total1, total2);
  store(t1.lambda, in(grips, total1, last1));
  store(t2.lambda, in(grips, total2, last2));
  twist(m, more, a, b);
  turn(t1, total1 - last1, a, b);
  turn(t2, total2 - last2, a, b);
  a = in(grips, a, lastA);
  b = in(grips, b, lastB);
  return in(grips, d1 * (total1 - last1) + d2 * (total2 - last2), none);
}

// How far each point is open where the substep has moved the bodies to.
template <int kCount>
inline void measureBlock(ContactBlock& m, const LaneMotion* motions) {
  const Since a = gatherSince(m.bodyA, motions), b = gatherSince(m.bodyB, motions);
  const Lanes apart = dot(load(m.n), a.u - b.u);
  for (int i = 0; i < kCount; ++i) {
    store(m.point[i].open, larger(gapOf(m, i, apart, a, b), all(0)));
  }
}

template <int kCount>
inline void sweepVelocitiesBlock(ContactBlock& m, LaneMotion* motions, VelocitySweep which) {
  if (which.first && which.rows != ContactRows::kFriction) measureBlock<kCount>(m, motions);
  Moved a = gather(m.bodyA, motions), b = gather(m.bodyB, motions);
  const Lanes3 n = load(m.n), between = a.u - b.u;
  const Lanes zero = all(0), along = dot(n, between);
  const bool holds = which.rows != ContactRows::kFriction;
  Lanes v[kCount], deltas[kCount], normal = zero, turning = zero, sum = zero;
  for (int i = 0; i < kCount; ++i) v[i] = rateOf(m.point[i], along, a, b);
  for (int i = 0; i < kCount; ++i) {
    ContactBlock::Point& p = m.point[i];
    const Lanes lambda = load(p.lambda);
    const Lanes total =
        holds ? larger(lambda - load(p.inverse) * (v[i] + load(p.open)), zero) : lambda;
    const Lanes delta = deltas[i] = total - lambda;
    store(p.lambda, total);
    tellOthers(m, i, delta, v);
    turn(p, delta, a, b);
    sum = sum + delta;
    normal = normal + total;
    turning = turning + load(p.lever) * total;
  }
  if (which.left < 2 && holds) {
    Lanes change = zero;
    for (int i = 0; i < kCount; ++i) {
      const Lanes inverse = load(m.point[i].inverse), squared = deltas[i] * deltas[i];
      change = change + wherePositive(inverse, squared / larger(inverse, all(kTiny)), zero);
    }
    store(m.change[which.left], change);
  }
  Lanes3 impulse = n * sum;
  if (which.rows != ContactRows::kNormal)
    impulse = impulse + sweepFriction(m, normal, turning, between, a, b);
  push(m, impulse, a, b);
  scatter(m.bodyA, load(m.massA), a, motions);
  scatter(m.bodyB, load(m.massB), b, motions);
}

// Velocities of a manifold, none of its points before the others, so that what is symmetric stays
// so: first by one amount for all that touch, further than what stops them (as over-relaxed sweeps
// over a column, 2 / (1 + sin pi/n): 1.8 is the best for 30 boxes and below 2 for any), then each
// by half of its own.
template <int kCount>
inline void balanceBlock(ContactBlock& m, LaneMotion* motions) {
  constexpr float kFurther = 1.8f, kOwn = 0.5f;
  Moved a = gather(m.bodyA, motions), b = gather(m.bodyB, motions);
  const Lanes3 n = load(m.n), between = a.u - b.u;
  const Lanes zero = all(0), one = all(1), tiny = all(kTiny), along = dot(n, between);
  Lanes v[kCount], lambda[kCount], touches[kCount], error = zero, sum = zero;
  for (int i = 0; i < kCount; ++i) {
    const ContactBlock::Point& p = m.point[i];
    lambda[i] = load(p.lambda);
    v[i] = rateOf(p, along, a, b) + larger(load(m.gap[i]), zero);
    const Lanes carries = wherePositive(lambda[i], one, wherePositive(zero - v[i], one, zero));
    touches[i] = wherePositive(load(p.inverse), carries, zero);
    error = error + touches[i] * v[i];
  }
  const auto forEachCoupling = [&](auto&& f) {
    for (int i = 0; i < kCount; ++i) {
      f(i, i, one / larger(load(m.point[i].inverse), tiny));
      for (int j = i + 1; j < kCount; ++j) {
        const Lanes coupled = load(m.coupling[couplingOf(i, j)]);
        f(i, j, coupled);
        f(j, i, coupled);
      }
    }
  };
  forEachCoupling([&](int i, int j, Lanes coupled) {
    sum = sum + wherePositive(touches[i] * touches[j], coupled, zero);
  });
  const Lanes common = wherePositive(sum, all(kFurther) * error / larger(sum, tiny), zero);
  Lanes given[kCount];
  for (int i = 0; i < kCount; ++i) {
    given[i] = larger(lambda[i] - touches[i] * common, zero) - lambda[i];
  }
  forEachCoupling([&](int i, int j, Lanes coupled) {
    v[j] = v[j] + wherePositive(load(m.point[i].inverse), coupled * given[i], zero);
  });
  Lanes normal = zero, turning = zero, pushed = zero;
  for (int i = 0; i < kCount; ++i) {
    ContactBlock::Point& p = m.point[i];
    const Lanes total = larger(lambda[i] + given[i] - all(kOwn) * load(p.inverse) * v[i], zero);
    store(p.lambda, total);
    turn(p, total - lambda[i], a, b);
    pushed = pushed + (total - lambda[i]);
    normal = normal + total;
    turning = turning + load(p.lever) * total;
  }
  const Lanes3 friction = sweepFriction(m, normal, turning, between, a, b);
  push(m, n * pushed + friction, a, b);
  scatter(m.bodyA, load(m.massA), a, motions);
  scatter(m.bodyB, load(m.massB), b, motions);
}

// f(block, number of its points as a constant) of every block.
template <class Block, class F>
inline void forEachBlock(Block* blocks, int count, F&& f) {
  for (int i = 0; i < count; ++i) {
    switch (blocks[i].points) {
      case 1:
        f(blocks[i], Count<1>{});
        break;
      case 2:
        f(blocks[i], Count<2>{});
        break;
      case 3:
        f(blocks[i], Count<3>{});
        break;
      default:
        f(blocks[i], Count<4>{});
    }
  }
}

}  // namespace
}  // namespace physics
