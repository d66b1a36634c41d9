// The kernels of body_block.h, for the files that compile them.
#pragma once

#include "physics/small_steps/body_block.h"
#include "physics/solver/turn_lanes.h"

namespace physics {
namespace {

using Lanes = BodyBlock::Lanes;

template <class N>
N at(const Lanes& of, int l) {
  return load(reinterpret_cast<const Num<N::kWidth>&>(of.v[l]));
}
template <class N>
void put(Lanes& to, int l, N a) {
  store(reinterpret_cast<Num<N::kWidth>&>(to.v[l]), a);
}
template <class N>
Triple<N> at3(const Lanes (&of)[3], int l) {
  return {at<N>(of[0], l), at<N>(of[1], l), at<N>(of[2], l)};
}
template <class N>
void put3(Lanes (&to)[3], int l, const Triple<N>& a) {
  put(to[0], l, a.x);
  put(to[1], l, a.y);
  put(to[2], l, a.z);
}
template <class N>
Triple<N> where(N test, const Triple<N>& a, const Triple<N>& b) {
  return {wherePositive(test, a.x, b.x), wherePositive(test, a.y, b.y),
          wherePositive(test, a.z, b.z)};
}

template <class N>
Triple<N> times(const Lanes (&symmetric)[6], int l, const Triple<N>& a) {
  const N xy = at<N>(symmetric[3], l), xz = at<N>(symmetric[4], l), yz = at<N>(symmetric[5], l);
  return {at<N>(symmetric[0], l) * a.x + xy * a.y + xz * a.z,
          xy * a.x + at<N>(symmetric[1], l) * a.y + yz * a.z,
          xz * a.x + yz * a.y + at<N>(symmetric[2], l) * a.z};
}

template <class N>
Triple<N> lowerTimes(const Lanes (&lower)[6], int l, const Triple<N>& a) {
  return {at<N>(lower[0], l) * a.x, at<N>(lower[1], l) * a.x + at<N>(lower[3], l) * a.y,
          at<N>(lower[2], l) * a.x + at<N>(lower[4], l) * a.y + at<N>(lower[5], l) * a.z};
}

// R diag(principal) R^T
template <class N>
void toWorld(const N (&q)[4], const Triple<N>& principal, N (&world)[6]) {
  const N x2 = q[1] + q[1], y2 = q[2] + q[2], z2 = q[3] + q[3], one = all<N>(1);
  const N wx = x2 * q[0], wy = y2 * q[0], wz = z2 * q[0], xx = x2 * q[1], xy = y2 * q[1],
          xz = z2 * q[1], yy = y2 * q[2], yz = z2 * q[2], zz = z2 * q[3];
  const Triple<N> row[3] = {{one - (yy + zz), xy - wz, xz + wy},
                            {xy + wz, one - (xx + zz), yz - wx},
                            {xz - wy, yz + wx, one - (xx + yy)}};
  Triple<N> scaled[3];
  for (int k = 0; k < 3; ++k) {
    scaled[k] = {row[k].x * principal.x, row[k].y * principal.y, row[k].z * principal.z};
    world[k] = dot(scaled[k], row[k]);
  }
  world[3] = dot(scaled[0], row[1]);
  world[4] = dot(scaled[0], row[2]);
  world[5] = dot(scaled[1], row[2]);
}

template <class N>
void takeTurn(const BodyBlock& b, int l, N (&q)[4]) {
  for (int k = 0; k < 4; ++k) q[k] = at<N>(b.q[k], l);
}

// omega and half a substep on, by I^-1 (-omega x I omega); where that turns far, as it turns
// freely.
template <class N>
Triple<N> meanSpin(const BodyBlock& b, int l, N turns, const Triple<N>& w) {
  const N h = at<N>(b.h, l);
  const Triple<N> gyro = times(b.inverse, l, cross(w, times(b.startInertia, l, w)));
  Triple<N> mean = w - gyro * (all<N>(0.5) * h);
  const N far = h * h * squaredNorm(w) - all<N>(kResolvedTurn * kResolvedTurn);
  const N isFar = wherePositive(turns, far, all<N>(0));
  if (!anyPositive(isFar)) return mean;
  Num<N::kWidth> flags, spins[3];
  store(flags, isFar);
  store3(spins, mean);
  for (int k = 0; k < N::kWidth; ++k) {
    if (!(flags.v[k] > 0)) continue;
    const int i = l + k;
    double spin[3] = {b.w[0].v[i], b.w[1].v[i], b.w[2].v[i]};
    freeSpin({b.inertia[0].v[i], b.inertia[1].v[i], b.inertia[2].v[i]},
             {b.q[0].v[i], b.q[1].v[i], b.q[2].v[i], b.q[3].v[i]}, b.h.v[i], spin);
    for (int c = 0; c < 3; ++c) spins[c].v[k] = spin[c];
  }
  return load3<N>(spins);
}

template <class N>
void predict(BodyBlock& b, int l) {
  const N h = at<N>(b.h, l), turns = at<N>(b.turns, l);
  put3(b.u, l, at3<N>(b.u, l) * h);
  const Triple<N> w = at3<N>(b.w, l);
  Triple<N> theta = w * h;
  if (anyPositive(turns)) {
    N q[4], inertia[6];
    takeTurn(b, l, q);
    toWorld(q, at3<N>(b.inertia, l), inertia);
    for (int k = 0; k < 6; ++k) put(b.startInertia[k], l, inertia[k]);
    theta = where(turns, meanSpin(b, l, turns, w) * h, theta);
    put3(b.spin, l, theta);
  }
  put3(b.theta, l, theta);
}

template <class N>
void give(BodyBlock& b, int l) {
  put3(b.nowU, l, at3<N>(b.u, l));
  put3(b.nowTurn, l, lowerTimes(b.inverseRoot, l, at3<N>(b.theta, l)));
}

template <class N>
void take(BodyBlock& b, int l) {
  const Triple<N> u = at3<N>(b.u, l), theta = at3<N>(b.theta, l);
  const Triple<N> more = at3<N>(b.nowU, l) - at3<N>(b.knownU, l),
                  turn = at3<N>(b.nowTurn, l) - at3<N>(b.knownTurn, l);
  put3(b.u, l, where(at<N>(b.moves, l), u + more, u));
  put3(b.theta, l, where(at<N>(b.isTurned, l), theta + lowerTimes(b.root, l, turn), theta));
}

// The inertia turns with the body, and its angular momentum is kept.
template <class N>
void turnInertia(BodyBlock& b, int l, N turns, const N (&q)[4]) {
  N inverse[6];
  toWorld(q, at3<N>(b.inverseInertia, l), inverse);
  for (int k = 0; k < 6; ++k) {
    put(b.inverse[k], l, wherePositive(turns, inverse[k], at<N>(b.inverse[k], l)));
  }
  const Triple<N> theta = at3<N>(b.theta, l),
                  turned = at3<N>(b.w, l) * at<N>(b.h, l) + (theta - at3<N>(b.spin, l));
  const Triple<N> atEnd = times(b.inverse, l, times(b.startInertia, l, turned));
  put3(b.theta, l, where(turns, atEnd, theta));
  put3(b.nowU, l, where(turns, at3<N>(b.u, l), at3<N>(b.nowU, l)));
  put3(b.nowTurn, l, where(turns, lowerTimes(b.inverseRoot, l, atEnd), at3<N>(b.nowTurn, l)));
}

template <class N>
void displace(BodyBlock& b, int l) {
  take<N>(b, l);
  N from[4], e[4], q[4];
  takeTurn(b, l, from);
  exponential(at3<N>(b.theta, l), e);
  turnFurther(e, from, q);
  const N scale =
      all<N>(1.5) - all<N>(0.5) * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int k = 0; k < 4; ++k) {
    q[k] = q[k] * scale;
    put(b.q[k], l, q[k]);
  }
  put(b.sinceRows[0], l, squaredNorm(lowerTimes(b.root, l, at3<N>(b.sinceRows, l))));
  const N turns = at<N>(b.turns, l);
  if (anyPositive(turns)) turnInertia(b, l, turns, q);
}

template <class N>
void end(BodyBlock& b, int l) {
  take<N>(b, l);
  const N rate = at<N>(b.rate, l);
  put3(b.u, l, at3<N>(b.u, l) * rate);
  put3(b.theta, l, at3<N>(b.theta, l) * rate);
}

template <class N, void (*kStage)(BodyBlock&, int)>
void inParts(BodyBlock& b) {
  for (int l = 0; l < BodyBlock::kLanes; l += N::kWidth) kStage(b, l);
}

template <class N>
constexpr BodyKernels bodyTableOf() {
  return {inParts<N, predict<N>>, inParts<N, give<N>>, inParts<N, displace<N>>, inParts<N, end<N>>};
}

}  // namespace
}  // namespace physics
