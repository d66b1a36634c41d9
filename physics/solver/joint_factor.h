// The part of the joint kernels that builds A = J M^-1 J^T + alpha and factors it.
#pragma once

#include "physics/solver/joint_columns.h"

namespace physics {
namespace {

// Keeps the factor regular where rows repeat each other (loops): relative to the row's own A.
constexpr double kRedundancy = 1e-7;

// A factor serves as long as no body has turned by more [rad] since, and its M^-1 was not smaller
// by a larger share (in its determinant): what a solve leaves of an error is of that order, and
// the next one takes the same share of it.
constexpr double kKeptTurn = 0.1, kKeptMass = 0.2;

// M^-1 J^T of the angular part, a column for each row of J, in lanes where `test` is > 0.
template <class N>
void respond(N test, const JointShape& shape, const JointLanes<N::kWidth>& row, int b,
             const JointBody<N::kWidth>& body, JointFactor<N::kWidth>& factor) {
  const N xx = load(body.inertia[0]), yy = load(body.inertia[1]), zz = load(body.inertia[2]);
  const N xy = load(body.inertia[3]), xz = load(body.inertia[4]), yz = load(body.inertia[5]);
  const Triple<N> x = {xx, xy, xz}, y = {xy, yy, yz}, z = {xz, yz, zz};
  auto* to = factor.response[b];
  if (shape.isGap) {
    const Triple<N> a = load3<N>(row.angular[b]);
    storeWhere3(test, to, z * a.y - y * a.z);
    storeWhere3(test, to + 3, x * a.z - z * a.x);
    storeWhere3(test, to + 6, y * a.x - x * a.y);
    return;
  }
  for (int r = 0; r < shape.rows; ++r) {
    const Triple<N> j = load3<N>(row.angular[b] + 3 * r);
    storeWhere3(test, to + 3 * r, x * j.x + y * j.y + z * j.z);
  }
}

double signOf(int place) { return place == 0 ? 1 : -1; }

// J_k M^-1 J_l^T of the body that is the p-th of the gap k and the q-th of the gap l.
template <class N>
void coupleGaps(const Of<N>& s, int k, int p, int l, int q, N (&sum)[9]) {
  const auto* response = s.factors[l].response[q];
  const N m = all<N>(signOf(p) * signOf(q)) * load(s.bodies[s.shapes[l].body[q]].inverseMass);
  const Triple<N> a = load3<N>(s.rows[k].angular[p]);
  const Triple<N> x = cross(a, load3<N>(response)), y = cross(a, load3<N>(response + 3)),
                  z = cross(a, load3<N>(response + 6));
  sum[0] = m + x.x, sum[1] = x.y, sum[2] = x.z;
  sum[3] = y.x, sum[4] = m + y.y, sum[5] = y.z;
  sum[6] = z.x, sum[7] = z.y, sum[8] = m + z.z;
}

// Adds J_k M^-1 J_l^T of the body that is k's p-th and l's q-th.
template <int R, int C, class N>
void couple(const Of<N>& s, int k, int p, int l, int q, N (&sum)[9]) {
  const JointShape &later = s.shapes[k], &earlier = s.shapes[l];
  const auto &rowK = s.rows[k], &rowL = s.rows[l];
  const N m = load(s.bodies[earlier.body[q]].inverseMass);
  const auto linear = [&](const auto& row, int b, int r) {
    return load3<N>(row.linear[b] + 3 * r);
  };
  if (R == C && later.isGap && earlier.isGap) {
    const N signedMass = all<N>(signOf(p) * signOf(q)) * m;
    for (int r = 0; r < R; ++r) sum[r * R + r] = sum[r * R + r] + signedMass;
  } else if (later.isGap && earlier.hasLinear) {
    const N signedMass = all<N>(signOf(p)) * m;
    for (int c = 0; c < C && c < earlier.rows; ++c) {
      const Triple<N> j = linear(rowL, q, c) * signedMass;
      N* to = sum + c * R;
      to[0] = to[0] + j.x;
      if constexpr (R == 3) to[1] = to[1] + j.y, to[2] = to[2] + j.z;
    }
  } else if (earlier.isGap && later.hasLinear) {
    const N signedMass = all<N>(signOf(q)) * m;
    for (int r = 0; r < R && r < later.rows; ++r) {
      const Triple<N> j = linear(rowK, p, r) * signedMass;
      sum[r] = sum[r] + j.x;
      if constexpr (C == 3) sum[R + r] = sum[R + r] + j.y, sum[2 * R + r] = sum[2 * R + r] + j.z;
    }
  } else if (later.hasLinear && earlier.hasLinear) {
    for (int r = 0; r < later.rows; ++r) {
      const Triple<N> j = linear(rowK, p, r) * m;
      for (int c = 0; c < earlier.rows; ++c)
        sum[c * R + r] = sum[c * R + r] + dot(j, linear(rowL, q, c));
    }
  }
  if (!later.hasAngular || !earlier.hasAngular) return;
  for (int c = 0; c < C && c < earlier.rows; ++c) {
    const Triple<N> response = load3<N>(s.factors[l].response[q] + 3 * c);
    if (R == 3 && later.isGap) {
      const Triple<N> moved = cross(load3<N>(rowK.angular[p]), response);
      N* to = sum + c * R;
      to[0] = to[0] + moved.x;
      if constexpr (R == 3) to[1] = to[1] + moved.y, to[2] = to[2] + moved.z;
      continue;
    }
    for (int r = 0; r < R && r < later.rows; ++r) {
      N& entry = sum[c * R + r];
      entry = entry + dot(load3<N>(rowK.angular[p] + 3 * r), response);
    }
  }
}

constexpr int triangle(int r, int c) { return r * (r + 1) / 2 + c; }

// Adds the lower triangle of J M^-1 J^T of a body of row i.
template <int R, class N>
void coupleSelf(const Of<N>& s, int i, int b, N (&sum)[6]) {
  const JointShape& shape = s.shapes[i];
  const auto& row = s.rows[i];
  const auto* response = s.factors[i].response[b];
  const N m = load(s.bodies[shape.body[b]].inverseMass);
  if (R == 3 && shape.isGap) {
    const Triple<N> a = load3<N>(row.angular[b]), x = load3<N>(response),
                    y = load3<N>(response + 3), z = load3<N>(response + 6);
    sum[0] = sum[0] + (m + (a.y * x.z - a.z * x.y));
    sum[1] = sum[1] + (a.z * x.x - a.x * x.z);
    sum[2] = sum[2] + (m + (a.z * y.x - a.x * y.z));
    sum[3] = sum[3] + (a.x * x.y - a.y * x.x);
    sum[4] = sum[4] + (a.x * y.y - a.y * y.x);
    sum[5] = sum[5] + (m + (a.x * z.y - a.y * z.x));
    return;
  }
  for (int r = 0; r < R && r < shape.rows; ++r) {
    for (int c = 0; c <= r; ++c) {
      N& entry = sum[triangle(r, c)];
      if (shape.hasLinear) {
        entry = entry + dot(load3<N>(row.linear[b] + 3 * r), load3<N>(row.linear[b] + 3 * c)) * m;
      }
      if (shape.hasAngular) {
        entry = entry + dot(load3<N>(row.angular[b] + 3 * r), load3<N>(response + 3 * c));
      }
    }
  }
}

// A_ii, and 1 on the diagonal of lanes in which the row is held.
template <int R, class N>
void buildDiagonal(const Of<N>& s, int i) {
  const JointShape& shape = s.shapes[i];
  const auto& row = s.rows[i];
  auto& factor = s.factors[i];
  const N stale = load(*s.stale);
  N a[6];
  for (N& entry : a) entry = all<N>(0);
  for (int b = 0; b < shape.bodyCount; ++b) {
    if (!shape.moves[b]) continue;
    if (shape.hasAngular) respond<N>(stale, shape, row, b, s.bodies[shape.body[b]], factor);
    coupleSelf<R, N>(s, i, b, a);
  }
  N trace = a[0];
  if constexpr (R == 3) trace = trace + a[2] + a[5];
  const N mean = trace * all<N>(1.0 / shape.rows);
  const N yields = load(row.regularisation) * mean;
  storeWhere(stale, factor.yields, yields);
  const N extra = yields + wherePositive(mean, all<N>(kRedundancy) * mean, all<N>(1));
  const N free = i < s.tailStart ? load(row.free) : all<N>(1);
  for (int r = 0; r < R; ++r) {
    for (int c = 0; c <= r; ++c) {
      N entry = a[triangle(r, c)] + load(row.alpha[triangle(r, c)]);
      if (r == c) entry = r < shape.rows ? entry + extra : all<N>(1);
      store(factor.diagonal[triangle(r, c)], wherePositive(free, entry, all<N>(r == c ? 1 : 0)));
    }
  }
}

template <int R, int C, class N>
void buildBlock(const Of<N>& s, int k, int i, const JointBelow& below) {
  N sum[9];
  const JointMeeting& meeting = s.meetings[below.block];
  if (R == 3 && C == 3 && meeting.count == 1 && s.shapes[k].isGap && s.shapes[i].isGap) {
    coupleGaps<N>(s, k, meeting.later[0], i, meeting.earlier[0], sum);
  } else {
    for (N& entry : sum) entry = all<N>(0);
    for (int m = 0; m < meeting.count; ++m) {
      couple<R, C>(s, k, meeting.later[m], i, meeting.earlier[m], sum);
    }
  }
  // What the tail holds is left out where the tail is solved.
  const N later = k < s.tailStart ? load(s.rows[k].free) : all<N>(1);
  const N free = wherePositive(later, load(s.rows[i].free), all<N>(0));
  for (int e = 0; e < R * C; ++e) {
    store(s.entries[below.at + e], wherePositive(free, sum[e], all<N>(0)));
  }
}

template <int R, class N>
void invert(N stale, JointFactor<N::kWidth>& factor) {
  const auto* d = factor.diagonal;
  if constexpr (R == 1) {
    storeWhere(stale, factor.inverse[0], all<N>(1) / load(d[0]));
    return;
  }
  const N a = load(d[0]), b = load(d[1]), c = load(d[2]), e = load(d[3]), f = load(d[4]),
          g = load(d[5]);  // a; b c; e f g
  const N ca = c * g - f * f, cb = e * f - b * g, ce = b * f - c * e;
  const N scale = all<N>(1) / (a * ca + b * cb + e * ce);
  const N inverse[6] = {ca, cb, a * g - e * e, ce, b * e - a * f, a * c - b * b};
  for (int k = 0; k < 6; ++k) storeWhere(stale, factor.inverse[k], inverse[k] * scale);
}

constexpr int symmetric(int r, int c) { return r > c ? triangle(r, c) : triangle(c, r); }

// L_ki = A_ki D_ii^-1
template <int R, int C, class N>
void scale(N stale, const Num<N::kWidth>* entry, const JointFactor<N::kWidth>& factor,
           Num<N::kWidth>* scaled, Column<R, N> (&columns)[C]) {
  Column<R, N> a[C];
  for (int c = 0; c < C; ++c) a[c] = loadColumn<R, N>(entry + c * R);
  for (int c = 0; c < C; ++c) {
    columns[c] = a[0] * load(factor.inverse[symmetric(0, c)]);
    for (int k = 1; k < C; ++k) {
      columns[c] = columns[c] + a[k] * load(factor.inverse[symmetric(k, c)]);
    }
  }
  for (int c = 0; c < C; ++c) storeColumnWhere<R, N>(stale, scaled + c * R, columns[c]);
}

// to -= L_qi A_pi^T
template <int R, int C, int I, class N>
void update(Num<N::kWidth>* to, const Column<R, N> (&scaled)[I], const Num<N::kWidth>* entry) {
  Column<R, N> columns[C];
  for (int c = 0; c < C; ++c) {
    columns[c] = loadColumn<R, N>(to + c * R) - product<R, I, C, N>(scaled, entry + c);
  }
  for (int c = 0; c < C; ++c) storeColumn<R, N>(to + c * R, columns[c]);
}

// The lower triangle of that of a block on the diagonal.
template <int R, int I, class N>
void updateDiagonal(Num<N::kWidth>* to, const Column<R, N> (&scaled)[I],
                    const Num<N::kWidth>* entry) {
  Num<N::kWidth> sums[R * R];
  for (int c = 0; c < R; ++c) {
    storeColumn<R, N>(sums + c * R, product<R, I, R, N>(scaled, entry + c));
  }
  for (int c = 0; c < R; ++c) {
    for (int r = c; r < R; ++r) {
      auto& target = to[triangle(r, c)];
      store(target, load(target) - load(sums[c * R + r]));
    }
  }
}

// The same of an entry of the tail, whose rows are one high, and which stays in other lanes.
template <int I, class N>
void updateTail(const Of<N>& s, int row, const JointBelow& p, const N (&scaled)[I]) {
  auto& to = s.tail.a[triangle(row - s.tailStart, p.to - s.tailStart)];
  storeWhere(load(*s.stale), to, load(to) - product<1, I, 1, N>(scaled, s.entries + p.at));
}

template <int kSize>
struct Size {
  static constexpr int value = kSize;
};

template <class F>
void withSize(int size, F&& f) {
  size == 1 ? f(Size<1>{}) : f(Size<3>{});
}

template <class N>
void eliminate(const Of<N>& s, int i) {
  auto& factor = s.factors[i];
  const JointColumn& column = s.columns[i];
  const JointBelow* below = s.below + column.start;
  const int *used = s.usedBelow + column.start, count = s.usedCounts[i];
  const N stale = load(*s.stale);
  withSize(s.shapes[i].size, [&](auto size) {
    constexpr int kI = decltype(size)::value;
    invert<kI, N>(stale, factor);
    for (int u = 0; u < count; ++u) {
      const JointBelow& q = below[used[u]];
      withSize(s.shapes[q.to].size, [&](auto high) {
        constexpr int kR = decltype(high)::value;
        Column<kR, N> scaled[kI];
        scale<kR, kI, N>(stale, s.entries + q.at, factor, s.scaled + q.at, scaled);
        const int* target = s.updates + column.updates + used[u] * (used[u] + 1) / 2;
        for (int v = 0; v < u; ++v) {
          const JointBelow& p = below[used[v]];
          if (p.to >= s.tailStart) {  // so is q.to
            if constexpr (kR == 1) updateTail<kI, N>(s, q.to, p, scaled);
            continue;
          }
          withSize(s.shapes[p.to].size, [&](auto wide) {
            update<kR, decltype(wide)::value, kI, N>(s.entries + target[used[v]], scaled,
                                                     s.entries + p.at);
          });
        }
        if (q.to < s.tailStart) {
          updateDiagonal<kR, kI, N>(s.factors[q.to].diagonal, scaled, s.entries + q.at);
          return;
        }
        if constexpr (kR == 1) updateTail<kI, N>(s, q.to, q, scaled);
      });
    }
  });
}

// A of the rows of the tail, where the others are not eliminated yet.
template <class N>
void buildTail(const Of<N>& s) {
  const JointTail<N::kWidth>& tail = s.tail;
  const N stale = load(*s.stale);
  int count = 0;
  for (int i = s.tailStart; i < s.rowCount; ++i) {
    if (!s.used[i]) continue;
    const int place = i - s.tailStart;
    for (int k = 0; k < count; ++k) {
      storeWhere(stale, tail.a[triangle(place, tail.places[k])], all<N>(0));
    }
    tail.places[count++] = place;
    buildDiagonal<1, N>(s, i);
    storeWhere(stale, tail.a[triangle(place, place)], load(s.factors[i].diagonal[0]));
  }
  *tail.count = count;
  *tail.isFactored = false;
  for (int k = 0; k < tail.pairCount; ++k) {
    const JointPair& pair = tail.pairs[k];
    const int later = s.tailStart + pair.later, earlier = s.tailStart + pair.earlier;
    if (!s.used[later] || !s.used[earlier]) continue;
    N sum = all<N>(0);
    for (int m = 0; m < pair.meeting.count; ++m) {
      const Triple<N> response = load3<N>(s.factors[earlier].response[pair.meeting.earlier[m]]);
      sum = sum + dot(load3<N>(s.rows[later].angular[pair.meeting.later[m]]), response);
    }
    storeWhere(stale, tail.a[triangle(pair.later, pair.earlier)], sum);
  }
}

template <class N>
N volume(const JointBody<N::kWidth>& body) {
  const N xx = load(body.inertia[0]), yy = load(body.inertia[1]), zz = load(body.inertia[2]);
  const N xy = load(body.inertia[3]), xz = load(body.inertia[4]), yz = load(body.inertia[5]);
  return xx * (yy * zz - yz * yz) - xy * (xy * zz - xz * yz) + xz * (xy * yz - xz * yy);
}

template <class N>
void findChanged(const Of<N>& s, bool (&changed)[N::kWidth]) {
  N most = all<N>(0);
  for (int i = 0; i < s.bodyCount; ++i) {
    const JointBody<N::kWidth>& body = s.bodies[i];
    const Triple<N> turned = load3<N>(body.theta) - load3<N>(s.factored[i].theta);
    const N before = load(s.factored[i].volume), more = volume<N>(body) - before;
    most = larger(most, squaredNorm(turned) - all<N>(kKeptTurn * kKeptTurn));
    most = larger(most, more - all<N>(kKeptMass) * before);
  }
  storePositive(most, changed);
}

template <class N>
void respondAll(const Of<N>& s) {
  for (int i = 0; i < s.rowCount; ++i) {
    const JointShape& shape = s.shapes[i];
    if (!s.used[i] || !shape.hasAngular) continue;
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      respond<N>(all<N>(1), shape, s.rows[i], b, s.bodies[shape.body[b]], s.factors[i]);
    }
  }
}

// Of lanes that are stale; the others keep theirs, and what is worked out on the way is none of
// their business.
template <class N>
void factorize(const Of<N>& s) {
  const N stale = load(*s.stale);
  for (int i = 0; i < s.bodyCount; ++i) {
    storeWhere3(stale, s.factored[i].theta, load3<N>(s.bodies[i].theta));
    storeWhere(stale, s.factored[i].volume, volume<N>(s.bodies[i]));
  }
  for (int i = 0; i < s.tailStart; ++i) {
    if (!s.used[i]) continue;
    withSize(s.shapes[i].size, [&](auto size) { buildDiagonal<decltype(size)::value, N>(s, i); });
  }
  buildTail<N>(s);
  for (int i = 0; i < s.tailStart; ++i) {
    if (!s.used[i]) continue;
    const JointColumn& column = s.columns[i];
    int count = 0;
    for (int k = 0; k < column.count; ++k) {
      const JointBelow& below = s.below[column.start + k];
      if (!s.used[below.to]) continue;
      s.usedBelow[column.start + count++] = k;
      withSize(s.shapes[below.to].size, [&](auto high) {
        withSize(s.shapes[i].size, [&](auto wide) {
          buildBlock<decltype(high)::value, decltype(wide)::value, N>(s, below.to, i, below);
        });
      });
    }
    s.usedCounts[i] = count;
  }
  for (int i = 0; i < s.tailStart; ++i) {
    if (s.used[i]) eliminate<N>(s, i);
  }
}

}  // namespace
}  // namespace physics
