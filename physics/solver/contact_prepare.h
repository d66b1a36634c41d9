// Rows of contacts from arms, normals and inertias: a part of the kernels of contact_block.h.
#pragma once

#include "physics/solver/contact_lanes.h"

namespace physics {
namespace {

constexpr float kNoTurn = 1e-20f;  // [1/(kg m^2)], far above kUnturned^2

struct Roots {
  Lanes mass, root[6];
};
inline Roots gatherMass(const int (&slot)[8], const LaneMass* masses) {
  Lanes rows[8];
  for (int l = 0; l < 8; ++l) rows[l] = load(masses[slot[l]].root);
  transpose(rows);
  return {rows[6], {rows[0], rows[1], rows[2], rows[3], rows[4], rows[5]}};
}

// root^T v
inline Lanes3 turned(const Roots& m, const Lanes3& v) {
  return {m.root[0] * v.x + m.root[1] * v.y + m.root[2] * v.z, m.root[3] * v.y + m.root[4] * v.z,
          m.root[5] * v.z};
}

// A unit vector normal to n: across its smaller of x and z.
inline Lanes3 anyNormal(const Lanes3& n) {
  const Lanes zero = all(0), x2 = n.x * n.x, z2 = n.z * n.z, test = z2 - x2;
  const Lanes3 d = {wherePositive(test, zero, zero - n.y), wherePositive(test, n.z, n.x),
                    wherePositive(test, zero - n.y, zero)};
  return d * (all(1) / root(dot(d, d)));
}

inline void prepareTangent(ContactBlock::Tangent& t, const Lanes3& d, const Lanes3& armA,
                           const Lanes3& armB, const Roots& a, const Roots& b) {
  store(t.d, d);
  store(t.wA, turned(a, cross(armA, d)));
  store(t.wB, turned(b, cross(armB, d)));
}

// The angular part of J M^-1 J^T between two rows.
template <class Row, class Other>
inline Lanes turnedBy(const Row& row, const Other& other) {
  return dot(load(row.wA), load(other.wA)) + dot(load(row.wB), load(other.wB));
}

inline void prepareTwist(ContactBlock& m, const Lanes3& n, const Roots& a, const Roots& b) {
  const Lanes3 twistA = turned(a, n), twistB = turned(b, n);
  store(m.twistA, twistA);
  store(m.twistB, twistB);
  const Lanes twist = dot(twistA, twistA) + dot(twistB, twistB), least = all(kNoTurn);
  store(m.twistInverse, wherePositive(twist - least, all(1) / larger(twist, least), all(0)));
  for (ContactBlock::Tangent& t : m.tangent) {
    store(t.twisted, dot(load(t.wA), twistA) + dot(load(t.wB), twistB));
  }
}

inline void prepareFriction(ContactBlock& m, const Lanes3& n, const Roots& a, const Roots& b,
                            const Lanes3& centreA, const Lanes3& centreB) {
  const Lanes zero = all(0), mass = a.mass + b.mass;
  ContactBlock::Tangent &t1 = m.tangent[0], &t2 = m.tangent[1];
  const Lanes3 d1 = anyNormal(n), d2 = cross(n, d1);
  prepareTangent(t1, d1, centreA, centreB, a, b);
  prepareTangent(t2, d2, centreA, centreB, a, b);
  const Lanes a11 = mass + turnedBy(t1, t1), a22 = mass + turnedBy(t2, t2), a12 = turnedBy(t1, t2);
  const Lanes determinant = a11 * a22 - a12 * a12;
  const Lanes inverse = wherePositive(determinant, all(1) / larger(determinant, all(kTiny)), zero);
  store(m.inverse11, a22 * inverse);
  store(m.inverse12, zero - a12 * inverse);
  store(m.inverse22, a11 * inverse);
  prepareTwist(m, n, a, b);
  // The last friction, which the host left as a world vector in the `lambda` of both and `change`.
  const Lanes3 last = {load(t1.lambda), load(t2.lambda), load(m.change[0])};
  store(t1.lambda, dot(last, d1));
  store(t2.lambda, dot(last, d2));
}

inline void prepareBlock(ContactBlock& m, const LaneMass* masses, FrictionAt friction) {
  const Lanes zero = all(0), one = all(1), tiny = all(kTiny), soft = load(m.scale);
  const Roots a = gatherMass(m.bodyA, masses), b = gatherMass(m.bodyB, masses);
  store(m.massA, a.mass);
  store(m.massB, b.mass);
  const Lanes3 n = load(m.n);
  Lanes3 centreA = {zero, zero, zero}, centreB = centreA;
  Lanes sum = tiny, carried = zero;
  if (friction.byLoad) {
    for (int i = 0; i < m.points; ++i) carried = carried + load(m.point[i].lambda);
  }
  for (int i = 0; i < m.points; ++i) {
    const ContactBlock::Point& p = m.point[i];
    const Lanes exists = load(p.inverse);  // 1 or 0, from the host
    const Lanes near =
        larger(smaller(all(2) - load(m.gap[i]) / all(friction.reach), one), all(1e-3f));
    const Lanes weight = wherePositive(carried, load(p.lambda), near * exists);
    centreA = centreA + load(p.wA) * weight;
    centreB = centreB + load(p.wB) * weight;
    sum = sum + weight;
  }
  centreA = centreA * (one / sum);
  centreB = centreB * (one / sum);
  for (int i = 0; i < m.points; ++i) {
    ContactBlock::Point& p = m.point[i];
    const Lanes exists = load(p.inverse);
    const Lanes3 armA = load(p.wA), armB = load(p.wB), off = armA - centreA;
    store(p.lever, root(dot(off, off)));
    store(p.wA, turned(a, cross(armA, n)));
    store(p.wB, turned(b, cross(armB, n)));
    const Lanes resistance = a.mass + b.mass + turnedBy(p, p);
    store(p.inverse, wherePositive(resistance * exists, one / larger(resistance, tiny), zero));
    const Lanes stiffness = load(p.inverse) * soft * load(m.rate);
    const Lanes sag = (one - soft) * load(m.held[i]) / larger(stiffness, tiny);
    const Lanes drawn = wherePositive(stiffness, sag, zero);
    store(m.drawn[i], drawn);
    store(m.gap[i], load(m.gap[i]) - drawn);
    for (int k = 0; k < i; ++k) {
      store(m.coupling[couplingOf(k, i)], a.mass + b.mass + turnedBy(m.point[k], p));
    }
  }
  prepareFriction(m, n, a, b, centreA, centreB);
}

}  // namespace
}  // namespace physics
