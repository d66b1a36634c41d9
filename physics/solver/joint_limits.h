// The part of the joint kernels that is about limits: cones and twists, one-sided rows of one.
#pragma once

#include "physics/solver/joint_numbers.h"

namespace physics {
namespace {

constexpr double kNoBound = __builtin_inf();
constexpr double kInside = -1;  // an error of what is within its bounds, where only the sign counts
constexpr double kHalfTurn = 3.14159265358979323846;

// Inline: g++ hands it vectors over in memory, a seventh of a chain's time.
template <class N>
[[gnu::always_inline]] inline Triple<N> turned(const Num<N::kWidth>* q, const Triple<N>& v) {
  const Triple<N> axis = load3<N>(q + 1), half = cross(axis, v), t = half + half;
  return v + t * load(q[0]) + cross(axis, t);
}

// atan of 0 <= t <= 1, by two halvings atan t = 2 atan(t / (1 + sqrt(1 + t^2))) and the series.
template <class N>
N arcTangentUnit(N t) {
  const N one = all<N>(1);
  for (int k = 0; k < 2; ++k) t = t / (one + root(one + t * t));
  const N s = t * t;
  N sum = all<N>(1.0 / 25);
  sum = all<N>(-1.0 / 23) + s * sum;
  sum = all<N>(1.0 / 21) + s * sum;
  sum = all<N>(-1.0 / 19) + s * sum;
  sum = all<N>(1.0 / 17) + s * sum;
  sum = all<N>(-1.0 / 15) + s * sum;
  sum = all<N>(1.0 / 13) + s * sum;
  sum = all<N>(-1.0 / 11) + s * sum;
  sum = all<N>(1.0 / 9) + s * sum;
  sum = all<N>(-1.0 / 7) + s * sum;
  sum = all<N>(1.0 / 5) + s * sum;
  sum = all<N>(-1.0 / 3) + s * sum;
  return all<N>(4) * (t + t * s * sum);
}

// atan2, in (-pi, pi].
template <class N>
N arcTangent(N y, N x) {
  const N zero = all<N>(0), ay = larger(y, zero - y), ax = larger(x, zero - x);
  const N low = smaller(ax, ay), high = larger(ax, ay);
  const N unit = arcTangentUnit(low / wherePositive(high, high, all<N>(1)));
  N angle = wherePositive(ay - ax, all<N>(kHalfTurn / 2) - unit, unit);
  angle = wherePositive(zero - x, all<N>(kHalfTurn) - angle, angle);
  return wherePositive(zero - y, zero - angle, angle);
}

template <class N>
void oppose(JointLanes<N::kWidth>& row, const Triple<N>& gradient) {
  const N zero = all<N>(0);
  store3(row.angular[0], Triple<N>{zero, zero, zero} - gradient);
  store3(row.angular[1], gradient);
}

template <class N>
bool areAllPositive(N test) {
  return !anyPositive(wherePositive(test, all<N>(0), all<N>(1)));
}

// `inside` of what did not carry in the last substep; of what did, 0: it is evaluated.
template <class N>
N idle(const JointLanes<N::kWidth>& row, N inside) {
  return wherePositive(load(row.carried), all<N>(0), inside);
}

// The direction of n_i x n_j, or any normal where they are parallel.
template <class N>
Triple<N> turningAxis(const Triple<N>& cross, N sine, const Triple<N>& ni) {
  const N apart = sine - all<N>(1e-12);
  Triple<N> w = cross * (all<N>(1) / wherePositive(apart, sine, all<N>(1)));
  if (!anyPositive(all<N>(0) - apart)) return w;
  Num<N::kWidth> far, parts[3], n[3];
  store(far, apart);
  store3(parts, w);
  store3(n, ni);
  for (int l = 0; l < N::kWidth; ++l) {
    if (far.v[l] > 0) continue;
    double normal[3];
    normalTo({n[0].v[l], n[1].v[l], n[2].v[l]}, normal);
    for (int k = 0; k < 3; ++k) parts[k].v[l] = normal[k];
  }
  return load3<N>(parts);
}

// c = phi - phi_l, (88)-(90); physics/constraints/cone_limit.h
template <class N>
void seeCone(const JointBody<N::kWidth>& i, const JointBody<N::kWidth>& j, bool every,
             JointLanes<N::kWidth>& row) {
  const Triple<N> ni = turned<N>(i.q, load3<N>(row.fixed)),
                  nj = turned<N>(j.q, load3<N>(row.fixed + 3));
  const N cosine = dot(ni, nj);
  const N inside = every ? idle(row, cosine - load(row.fixed[7])) : all<N>(0);
  store(row.low, all<N>(-kNoBound));
  store(row.high, all<N>(0));
  store(row.c[0], all<N>(kInside));
  if (areAllPositive(inside)) return;
  const Triple<N> normal = cross(ni, nj);
  const N sine = root(dot(normal, normal));
  const N c = arcTangent(sine, cosine) - load(row.fixed[6]);
  store(row.c[0], wherePositive(inside, all<N>(kInside), c));
  oppose(row, turningAxis(normal, sine, ni));
}

// c = tau - low or tau - high, whichever is nearer; physics/constraints/twist_limit.h
template <class N>
void seeTwist(const JointBody<N::kWidth>& i, const JointBody<N::kWidth>& j, bool every,
              JointLanes<N::kWidth>& row) {
  const auto product = [](N aw, const Triple<N>& a, N bw, const Triple<N>& b, N& w, Triple<N>& v) {
    w = aw * bw - dot(a, b);
    v = b * aw + a * bw + cross(a, b);
  };
  const N zero = all<N>(0);
  const Triple<N> none = {zero, zero, zero}, n = load3<N>(row.fixed);
  N w;
  Triple<N> v;
  product(load(i.q[0]), none - load3<N>(i.q + 1), load(j.q[0]), load3<N>(j.q + 1), w, v);
  product(w, v, load(row.fixed[3]), none - load3<N>(row.fixed + 4), w, v);
  // d and -d are the same turn: that with w >= 0 has its twist within (-pi, pi].
  const N sign = wherePositive(zero - w, all<N>(-1), all<N>(1));
  w = w * sign;
  v = v * sign;
  const N a = dot(v, n);
  const N within = smaller(a - load(row.fixed[9]) * w, load(row.fixed[10]) * w - a);
  const N inside = every ? idle(row, within) : zero;
  store(row.low, all<N>(-kNoBound));
  store(row.high, zero);
  store(row.c[0], all<N>(kInside));
  if (areAllPositive(inside)) return;
  const N squared = w * w + a * a, tau = all<N>(2) * arcTangent(a, w);
  const N fromLow = tau - load(row.fixed[7]), toHigh = load(row.fixed[8]) - tau;
  const N nearHigh = fromLow - toHigh;
  const N c = wherePositive(nearHigh, zero - toHigh, fromLow);
  store(row.c[0], wherePositive(inside, all<N>(kInside), c));
  store(row.low,
        wherePositive(nearHigh, all<N>(-kNoBound), wherePositive(inside, all<N>(-kNoBound), zero)));
  store(row.high, wherePositive(nearHigh, zero, wherePositive(inside, zero, all<N>(kNoBound))));
  const N defined = squared - all<N>(1e-12);
  const N scale = all<N>(1) / wherePositive(defined, squared, all<N>(1));
  const Triple<N> inI = ((n * w + cross(v, n)) * w + v * a) * scale;
  const Triple<N> safe = {wherePositive(defined, inI.x, n.x), wherePositive(defined, inI.y, n.y),
                          wherePositive(defined, inI.z, n.z)};
  oppose(row, turned<N>(i.q, safe));
}

template <class N>
void seeLimits(const Of<N>& s, bool every) {
  for (int k = 0; k < s.rowCount; ++k) {
    const JointShape& shape = s.shapes[k];
    if (!every && !s.used[k]) continue;
    const auto &i = s.bodies[shape.body[0]], &j = s.bodies[shape.body[1]];
    if (shape.seen == JointSeen::kCone) seeCone<N>(i, j, every, s.rows[k]);
    if (shape.seen == JointSeen::kTwist) seeTwist<N>(i, j, every, s.rows[k]);
  }
}

template <class N>
N within(const JointLanes<N::kWidth>& row, N total) {
  return smaller(larger(total, load(row.low)), load(row.high));
}

// 1 where a and b differ.
template <class N>
N differ(N a, N b) {
  return wherePositive(a - b, all<N>(1), wherePositive(b - a, all<N>(1), all<N>(0)));
}

// A limit is free where it would move into what it may do, and where it carried in the last
// substep: where only one of two is, what it gives takes the bodies beyond the other, and they take
// turns.
template <class N>
void chooseLimits(const Of<N>& s) {
  const N zero = all<N>(0);
  for (int k = 0; k < s.rowCount; ++k) {
    if (!isLimit(s.shapes[k])) continue;
    auto& row = s.rows[k];
    const N free = differ(within<N>(row, load(row.left[0]) - load(row.c[0])), zero);
    store(row.free, wherePositive(free, free, load(row.carried)));
  }
}

template <class N>
void begin(const Of<N>& s) {
  const N zero = all<N>(0);
  for (int k = 0; k < s.rowCount; ++k) {
    auto& row = s.rows[k];
    const bool byKind = s.shapes[k].seen == JointSeen::kByKind;
    if (isLimit(s.shapes[k])) store(row.carried, differ(load(row.lambda[0]), zero));
    store3(row.lambda, Triple<N>{zero, zero, zero});
    store3(row.right, Triple<N>{zero, zero, zero});
    store(row.free, all<N>(byKind ? 0 : 1));
  }
}

template <class N>
void keepCarrying(const Of<N>& s, bool (&changed)[N::kWidth]) {
  const N zero = all<N>(0), one = all<N>(1);
  N most = zero;
  for (int k = 0; k < s.rowCount; ++k) {
    const JointShape& shape = s.shapes[k];
    if (shape.seen == JointSeen::kByKind) continue;
    auto& row = s.rows[k];
    const N carries = isLimit(shape) ? differ(load(row.lambda[0]), zero) : one;
    const N free = wherePositive(load(row.regularisation), zero, shape.stands ? carries : zero);
    if (k < s.tailStart) most = larger(most, differ(free, load(row.free)));
    store(row.free, free);
  }
  storePositive(most, changed);
}

}  // namespace
}  // namespace physics
