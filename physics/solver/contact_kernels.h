// The kernels of contact_block.h, for the two files that compile them. KERNELS names the table.
#include "physics/solver/contact_block.h"
#include "physics/solver/lanes.h"

namespace physics {
namespace {

constexpr float kTiny = 1e-30f;

struct Body {
  Lanes3 u, theta;
  Lanes pad[2];
  Lanes3 du, dtheta;
};

// Eight bodies, as they lie, into lanes and back.
inline void gather(const int (&slot)[8], const LaneMotion* motions, Body& body) {
  Lanes* rows = &body.u.x;
  for (int l = 0; l < 8; ++l) rows[l] = load(motions[slot[l]].u);
  transpose(rows);
}
inline void gatherAll(const int (&slot)[8], const LaneMotion* motions, Body& body) {
  gather(slot, motions, body);
  Lanes rows[8];
  for (int l = 0; l < 8; ++l) rows[l] = load(motions[slot[l]].du);
  transpose(rows);
  body.du = {rows[0], rows[1], rows[2]};
  body.dtheta = {rows[3], rows[4], rows[5]};
}
inline void scatter(const int (&slot)[8], Body& body, LaneMotion* motions) {
  Lanes* rows = &body.u.x;
  transpose(rows);
  for (int l = 0; l < 8; ++l) {
    if (slot[l] != 0) store(motions[slot[l]].u, rows[l]);
  }
}

inline Lanes rateAlong(const Lanes3& d, const Lanes3& torqueA, const Lanes3& torqueB, const Body& a,
                       const Body& b) {
  return dot(d, a.u - b.u) + dot(torqueA, a.theta) - dot(torqueB, b.theta);
}

template <class Row>
inline void give(const Row& row, const Lanes3& d, Lanes massA, Lanes massB, Lanes impulse, Body& a,
                 Body& b) {
  a.u = a.u + d * (massA * impulse);
  b.u = b.u - d * (massB * impulse);
  a.theta = a.theta + load(row.turnA) * impulse;
  b.theta = b.theta - load(row.turnB) * impulse;
}

inline Lanes3 times(const Lanes (&inertia)[6], const Lanes3& v) {
  return {inertia[0] * v.x + inertia[3] * v.y + inertia[4] * v.z,
          inertia[3] * v.x + inertia[1] * v.y + inertia[5] * v.z,
          inertia[4] * v.x + inertia[5] * v.y + inertia[2] * v.z};
}

struct Inertias {
  Lanes mass, inertia[6];
};
inline Inertias gatherMass(const int (&slot)[8], const LaneMass* masses) {
  Lanes rows[8];
  for (int l = 0; l < 8; ++l) rows[l] = load(&masses[slot[l]].inverse);
  transpose(rows);
  return {rows[0], {rows[1], rows[2], rows[3], rows[4], rows[5], rows[6]}};
}

template <class Row>
inline Lanes prepareRow(Row& row, const Lanes3& d, const Lanes3& armA, const Lanes3& armB,
                        const Inertias& a, const Inertias& b) {
  const Lanes3 torqueA = cross(armA, d), torqueB = cross(armB, d);
  const Lanes3 turnA = times(a.inertia, torqueA), turnB = times(b.inertia, torqueB);
  store(row.torqueA, torqueA);
  store(row.torqueB, torqueB);
  store(row.turnA, turnA);
  store(row.turnB, turnB);
  return a.mass + b.mass + dot(torqueA, turnA) + dot(torqueB, turnB);
}

// A unit vector normal to n: across its smaller of x and z.
inline Lanes3 anyNormal(const Lanes3& n) {
  const Lanes zero = all(0), x2 = n.x * n.x, z2 = n.z * n.z, test = z2 - x2;
  const Lanes3 d = {wherePositive(test, zero, zero - n.y), wherePositive(test, n.z, n.x),
                    wherePositive(test, zero - n.y, zero)};
  return d * (all(1) / root(dot(d, d)));
}

inline void prepareFriction(ContactBlock& m, const Lanes3& n, const Inertias& a, const Inertias& b,
                            const Lanes3& centreA, const Lanes3& centreB) {
  const Lanes zero = all(0), one = all(1), tiny = all(kTiny);
  const Lanes3 d1 = anyNormal(n), d2 = cross(n, d1);
  store(m.tangent[0].d, d1);
  store(m.tangent[1].d, d2);
  const Lanes a11 = prepareRow(m.tangent[0], d1, centreA, centreB, a, b);
  const Lanes a22 = prepareRow(m.tangent[1], d2, centreA, centreB, a, b);
  const Lanes a12 = dot(load(m.tangent[0].torqueA), load(m.tangent[1].turnA)) +
                    dot(load(m.tangent[0].torqueB), load(m.tangent[1].turnB));
  const Lanes determinant = a11 * a22 - a12 * a12;
  const Lanes inverse = wherePositive(determinant, one / larger(determinant, tiny), zero);
  store(m.inverse11, a22 * inverse);
  store(m.inverse12, zero - a12 * inverse);
  store(m.inverse22, a11 * inverse);
  const Lanes3 twistA = times(a.inertia, n), twistB = times(b.inertia, n);
  store(m.twistA, twistA);
  store(m.twistB, twistB);
  const Lanes twist = dot(n, twistA + twistB);
  store(m.twistInverse, wherePositive(twist, one / larger(twist, tiny), zero));
  // The last friction, which the host left as a world vector in the `lambda` of both and `change`.
  const Lanes3 last = {load(m.tangent[0].lambda), load(m.tangent[1].lambda), load(m.change)};
  store(m.tangent[0].lambda, dot(last, d1));
  store(m.tangent[1].lambda, dot(last, d2));
}

inline void prepareBlock(ContactBlock& m, const LaneMass* masses, float reach) {
  const Lanes zero = all(0), one = all(1), tiny = all(kTiny);
  const Inertias a = gatherMass(m.bodyA, masses), b = gatherMass(m.bodyB, masses);
  store(m.massA, a.mass);
  store(m.massB, b.mass);
  const Lanes3 n = load(m.n);
  Lanes3 centreA = {zero, zero, zero}, centreB = centreA;
  Lanes sum = tiny;
  for (const ContactBlock::Point& p : m.point) {
    const Lanes exists = load(p.inverse);  // 1 or 0, from the host
    const Lanes3 armA = load(p.turnA), armB = load(p.turnB);
    const Lanes near = larger(smaller(all(2) - load(p.gap) / all(reach), one), all(1e-3f));
    const Lanes weight = near * exists;
    centreA = centreA + armA * weight;
    centreB = centreB + armB * weight;
    sum = sum + weight;
  }
  centreA = centreA * (one / sum);
  centreB = centreB * (one / sum);
  for (ContactBlock::Point& p : m.point) {
    const Lanes exists = load(p.inverse);
    const Lanes3 armA = load(p.turnA), armB = load(p.turnB), off = armA - centreA;
    store(p.lever, root(dot(off, off)));
    const Lanes resistance = prepareRow(p, n, armA, armB, a, b);
    store(p.inverse, wherePositive(resistance * exists, one / larger(resistance, tiny), zero));
  }
  prepareFriction(m, n, a, b, centreA, centreB);
}

inline void warmStartBlock(ContactBlock& m, LaneMotion* motions) {
  Body a, b;
  gather(m.bodyA, motions, a);
  gather(m.bodyB, motions, b);
  const Lanes3 n = load(m.n);
  const Lanes massA = load(m.massA), massB = load(m.massB);
  Lanes sum = all(0);
  for (ContactBlock::Point& p : m.point) {
    const Lanes lambda = load(p.lambda);
    sum = sum + lambda;
    a.theta = a.theta + load(p.turnA) * lambda;
    b.theta = b.theta - load(p.turnB) * lambda;
  }
  a.u = a.u + n * (massA * sum);
  b.u = b.u - n * (massB * sum);
  for (ContactBlock::Tangent& t : m.tangent) {
    give(t, load(t.d), massA, massB, load(t.lambda), a, b);
  }
  const Lanes twist = load(m.twist);
  a.theta = a.theta + load(m.twistA) * twist;
  b.theta = b.theta - load(m.twistB) * twist;
  scatter(m.bodyA, a, motions);
  scatter(m.bodyB, b, motions);
}

inline Lanes gapOf(const ContactBlock::Point& p, const Lanes3& n, const Body& a, const Body& b) {
  return load(p.gap) + dot(n, a.du - b.du) + dot(load(p.torqueA), a.dtheta) -
         dot(load(p.torqueB), b.dtheta);
}

inline void sweepPositionsBlock(ContactBlock& m, LaneMotion* motions, float push) {
  Body a, b;
  gatherAll(m.bodyA, motions, a);
  gatherAll(m.bodyB, motions, b);
  const Lanes3 n = load(m.n);
  const Lanes massA = load(m.massA), massB = load(m.massB), zero = all(0), one = all(1);
  const Lanes soft = load(m.scale);
  Lanes deepest = all(kTiny);
  for (const ContactBlock::Point& p : m.point) deepest = larger(deepest, zero - gapOf(p, n, a, b));
  const Lanes share = smaller(soft * load(m.rate), all(push) / deepest);
  for (ContactBlock::Point& p : m.point) {
    const Lanes c = gapOf(p, n, a, b), lambda = load(p.lambda);
    const Lanes v = rateAlong(n, load(p.torqueA), load(p.torqueB), a, b);
    const Lanes scale = wherePositive(c, one, soft);
    const Lanes aim = wherePositive(c, c, share * c);
    const Lanes yields = (one - scale) * (lambda - load(p.held));
    const Lanes total = larger(lambda - load(p.inverse) * (scale * v + aim) - yields, zero);
    store(p.lambda, total);
    give(p, n, massA, massB, total - lambda, a, b);
  }
  scatter(m.bodyA, a, motions);
  scatter(m.bodyB, b, motions);
}

// The part of |lambda| <= nu_s limit, else of length nu_d limit.
inline Lanes onDisc(Lanes squared, Lanes staticLimit, Lanes dynamicLimit) {
  return wherePositive(squared - staticLimit * staticLimit,
                       dynamicLimit / root(larger(squared, all(kTiny))), all(1));
}

inline void sweepFriction(ContactBlock& m, Lanes normal, Lanes turning, const Lanes3& n, Body& a,
                          Body& b) {
  const Lanes nuS = load(m.staticFriction), nuD = load(m.dynamicFriction);
  const Lanes twist = load(m.twist);
  const Lanes wanted = twist - load(m.twistInverse) * dot(n, a.theta - b.theta);
  const Lanes kept = wanted * onDisc(wanted * wanted, nuS * turning, nuD * turning);
  store(m.twist, kept);
  a.theta = a.theta + load(m.twistA) * (kept - twist);
  b.theta = b.theta - load(m.twistB) * (kept - twist);
  ContactBlock::Tangent &t1 = m.tangent[0], &t2 = m.tangent[1];
  const Lanes3 d1 = load(t1.d), d2 = load(t2.d);
  const Lanes v1 = rateAlong(d1, load(t1.torqueA), load(t1.torqueB), a, b);
  const Lanes v2 = rateAlong(d2, load(t2.torqueA), load(t2.torqueB), a, b);
  const Lanes last1 = load(t1.lambda), last2 = load(t2.lambda), cross = load(m.inverse12);
  const Lanes w1 = last1 - (load(m.inverse11) * v1 + cross * v2);
  const Lanes w2 = last2 - (cross * v1 + load(m.inverse22) * v2);
  const Lanes share = onDisc(w1 * w1 + w2 * w2, nuS * normal, nuD * normal);
  const Lanes massA = load(m.massA), massB = load(m.massB);
  store(t1.lambda, w1 * share);
  store(t2.lambda, w2 * share);
  give(t1, d1, massA, massB, w1 * share - last1, a, b);
  give(t2, d2, massA, massB, w2 * share - last2, a, b);
}

// How far each point is open where the substep has moved the bodies to.
inline void measureBlock(ContactBlock& m, const LaneMotion* motions) {
  Body a, b;
  gatherAll(m.bodyA, motions, a);
  gatherAll(m.bodyB, motions, b);
  const Lanes3 n = load(m.n);
  for (ContactBlock::Point& p : m.point) store(p.open, larger(gapOf(p, n, a, b), all(0)));
}

inline void sweepVelocitiesBlock(ContactBlock& m, LaneMotion* motions) {
  Body a, b;
  gather(m.bodyA, motions, a);
  gather(m.bodyB, motions, b);
  const Lanes3 n = load(m.n);
  const Lanes massA = load(m.massA), massB = load(m.massB), zero = all(0);
  Lanes normal = zero, turning = zero, change = zero;
  for (ContactBlock::Point& p : m.point) {
    const Lanes lambda = load(p.lambda), inverse = load(p.inverse);
    const Lanes v = rateAlong(n, load(p.torqueA), load(p.torqueB), a, b);
    const Lanes total = larger(lambda - inverse * (v + load(p.open)), zero);
    const Lanes delta = total - lambda;
    store(p.lambda, total);
    give(p, n, massA, massB, delta, a, b);
    normal = normal + total;
    turning = turning + load(p.lever) * total;
    change = change + wherePositive(inverse, delta * delta / larger(inverse, all(kTiny)), zero);
  }
  store(m.change, change);
  sweepFriction(m, normal, turning, n, a, b);
  scatter(m.bodyA, a, motions);
  scatter(m.bodyB, b, motions);
}

void prepareAll(ContactBlock* blocks, int count, const LaneMass* masses, float reach) {
  for (int i = 0; i < count; ++i) prepareBlock(blocks[i], masses, reach);
}
void warmStartAll(ContactBlock* blocks, int count, LaneMotion* motions) {
  for (int i = 0; i < count; ++i) warmStartBlock(blocks[i], motions);
}
void sweepPositionsAll(ContactBlock* blocks, int count, LaneMotion* motions, float push) {
  for (int i = 0; i < count; ++i) sweepPositionsBlock(blocks[i], motions, push);
}
void measureAll(ContactBlock* blocks, int count, const LaneMotion* motions) {
  for (int i = 0; i < count; ++i) measureBlock(blocks[i], motions);
}
void sweepVelocitiesAll(ContactBlock* blocks, int count, LaneMotion* motions) {
  for (int i = 0; i < count; ++i) sweepVelocitiesBlock(blocks[i], motions);
}

}  // namespace

const ContactKernels KERNELS = {prepareAll, warmStartAll, sweepPositionsAll, measureAll,
                                sweepVelocitiesAll};

}  // namespace physics
