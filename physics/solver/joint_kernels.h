// The kernels of joint_block.h, for the files that compile them. What is done in one lane is the
// same, to the last bit, for any number of them.
#include "physics/solver/joint_block.h"
#include "physics/solver/joint_factor.h"
#include "physics/solver/joint_limits.h"
#include "physics/solver/joint_tail.h"
#include "physics/solver/lane_records.h"
#include "physics/solver/turn_lanes.h"

namespace physics {
namespace {

// The turn e after that of q.
template <class N>
void turnFurther(const N (&e)[4], const Num<N::kWidth> (&q)[4], Num<N::kWidth> (&to)[4]) {
  const N from[4] = {load(q[0]), load(q[1]), load(q[2]), load(q[3])};
  N turned[4];
  turnFurther(e, from, turned);
  for (int k = 0; k < 4; ++k) store(to[k], turned[k]);
}

template <class N>
void place(const Of<N>& s) {
  for (int i = 0; i < s.bodyCount; ++i) {
    JointBody<N::kWidth>& body = s.bodies[i];
    store3(body.x, load3<N>(body.startX) + load3<N>(body.u));
    N e[4];
    exponential(load3<N>(body.theta), e);
    turnFurther(e, body.startQ, body.q);
  }
}

template <class N>
void turnBack(const Of<N>& s) {
  const Triple<N> zero = {all<N>(0), all<N>(0), all<N>(0)};
  for (int i = 0; i < s.bodyCount; ++i) {
    JointBody<N::kWidth>& body = s.bodies[i];
    N e[4];
    exponential(zero - load3<N>(body.back), e);
    turnFurther(e, body.q, body.backQ);
  }
}

template <class N>
void seeGaps(const Of<N>& s, bool back) {
  const Triple<N> zero = {all<N>(0), all<N>(0), all<N>(0)};
  for (int i = 0; i < s.rowCount; ++i) {
    if (!s.shapes[i].isGap) continue;
    JointLanes<N::kWidth>& row = s.rows[i];
    const auto &a = s.bodies[s.shapes[i].body[0]], &b = s.bodies[s.shapes[i].body[1]];
    const Triple<N> armA = turned<N>(a.q, load3<N>(row.fixed)),
                    armB = turned<N>(b.q, load3<N>(row.fixed + 3));
    store3(row.arm[0], armA);
    store3(row.arm[1], armB);
    store3(row.angular[0], zero - (back ? turned<N>(a.backQ, load3<N>(row.fixed)) : armA));  // (72)
    store3(row.angular[1], back ? turned<N>(b.backQ, load3<N>(row.fixed + 3)) : armB);
    store3(row.c, (load3<N>(a.x) + armA) - (load3<N>(b.x) + armB));  // (71)
  }
}

// J of row i times what u and theta say of its bodies; rows of J, the others are zero.
template <class N, class F>
Triple<N> along(const Of<N>& s, int i, F&& motion) {
  const JointShape& shape = s.shapes[i];
  const auto& row = s.rows[i];
  N sum[3] = {all<N>(0), all<N>(0), all<N>(0)};
  Triple<N> u, theta;
  if (shape.isGap) {
    motion(s.bodies[shape.body[0]], u, theta);
    const Triple<N> first = u + cross(load3<N>(row.angular[0]), theta);
    motion(s.bodies[shape.body[1]], u, theta);
    return first - (u - cross(load3<N>(row.angular[1]), theta));
  }
  for (int b = 0; b < shape.bodyCount; ++b) {
    motion(s.bodies[shape.body[b]], u, theta);
    for (int r = 0; r < shape.rows; ++r) {
      if (shape.hasLinear) sum[r] = sum[r] + dot(load3<N>(row.linear[b] + 3 * r), u);
      if (shape.hasAngular) sum[r] = sum[r] + dot(load3<N>(row.angular[b] + 3 * r), theta);
    }
  }
  return {sum[0], sum[1], sum[2]};
}

template <class N>
Triple<N> alphaTimes(const Num<N::kWidth>* alpha, const Triple<N>& v) {
  const N b = load(alpha[1]), e = load(alpha[3]), f = load(alpha[4]);
  return {load(alpha[0]) * v.x + b * v.y + e * v.z, b * v.x + load(alpha[2]) * v.y + f * v.z,
          e * v.x + f * v.y + load(alpha[5]) * v.z};
}

template <class N>
void aim(const Of<N>& s, JointLanes<N::kWidth>& row, const Triple<N>& error) {
  const N zero = all<N>(0), free = wherePositive(load(*s.open), load(row.free), zero);
  store(row.right[0], wherePositive(free, zero - error.x, zero));
  store(row.right[1], wherePositive(free, zero - error.y, zero));
  store(row.right[2], wherePositive(free, zero - error.z, zero));
}

template <class N>
void aimAtErrors(const Of<N>& s) {
  for (int i = 0; i < s.rowCount; ++i) {
    if (!s.used[i]) continue;
    auto& row = s.rows[i];
    const Triple<N> since = along<N>(s, i, [](const auto& body, auto& u, auto& theta) {
      u = load3<N>(body.u) - load3<N>(body.seenU);
      theta = load3<N>(body.theta) - load3<N>(body.seenTheta);
    });
    const Triple<N> lambda = load3<N>(row.lambda);
    Triple<N> error = load3<N>(row.c) - load3<N>(row.left) + since;
    if (s.shapes[i].seen == JointSeen::kByKind) error = error + alphaTimes<N>(row.alpha, lambda);
    error = error + lambda * load(s.factors[i].yields);
    aim<N>(s, row, error);
  }
}

template <class N>
bool findOpen(const Of<N>& s, double tolerance) {
  N most = all<N>(-1);
  for (int i = 0; i < s.rowCount; ++i) {
    if (!s.used[i]) continue;
    const auto& row = s.rows[i];
    N scale = all<N>(1);
    if (s.shapes[i].hasWay) {
      scale = all<N>(0);
      for (int b = 0; b < s.shapes[i].bodyCount; ++b) {
        scale = larger(scale, squaredNorm(load3<N>(s.bodies[s.shapes[i].body[b]].u)));
        if (s.shapes[i].pulls) scale = larger(scale, squaredNorm(load3<N>(row.arm[b])));
      }
    }
    most = larger(most, squaredNorm(load3<N>(row.right)) - all<N>(tolerance * tolerance) * scale);
  }
  const N open = load(*s.open);
  store(*s.open, wherePositive(most, open, all<N>(0)));
  return anyPositive(wherePositive(most, open, all<N>(0)));
}

template <class N>
void aimAtVelocities(const Of<N>& s) {
  for (int i = 0; i < s.rowCount; ++i) {
    if (!s.used[i]) continue;
    aim<N>(s, s.rows[i], along<N>(s, i, [](const auto& body, auto& u, auto& theta) {
             u = load3<N>(body.u);
             theta = load3<N>(body.theta);
           }));
  }
}

// physics/constraints/pull_stiffness.h
template <class N>
void stiffen(const Of<N>& s) {
  const N zero = all<N>(0), one = all<N>(1);
  for (int i = 0; i < s.bodyCount; ++i) {
    for (Num<N::kWidth>& entry : s.bodies[i].stiffness) store(entry, zero);
  }
  for (int i = 0; i < s.rowCount; ++i) {
    const JointShape& shape = s.shapes[i];
    if (!shape.pulls) continue;
    const auto& row = s.rows[i];
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      Triple<N> f = {zero, zero, zero};
      if (shape.isGap) f = b == 0 ? load3<N>(row.lambda) : f - load3<N>(row.lambda);
      for (int r = 0; !shape.isGap && r < shape.rows; ++r) {
        f = f + load3<N>(row.linear[b] + 3 * r) * load(row.lambda[r]);
      }
      const N along = dot(f, load3<N>(row.arm[b])), size = squaredNorm(f);
      const N squared = wherePositive(size, size, one);  // where nothing pulls nothing is added
      const auto add = [&](int k, N first, N second) {
        auto& entry = s.bodies[shape.body[b]].stiffness[k];
        const N across = (k < 3 ? one : zero) - first * second / squared;
        store(entry, load(entry) + wherePositive(along, along * across, zero));
      };
      add(0, f.x, f.x), add(1, f.y, f.y), add(2, f.z, f.z);
      add(3, f.x, f.y), add(4, f.x, f.z), add(5, f.y, f.z);
    }
  }
}

template <class N>
void substitute(const Of<N>& s) {
  for (int i = 0; i < s.tailStart; ++i) {
    if (!s.used[i]) continue;
    const JointBelow* below = s.below + s.columns[i].start;
    const int* used = s.usedBelow + s.columns[i].start;
    withSize(s.shapes[i].size, [&](auto size) {
      constexpr int kI = decltype(size)::value;
      N y[kI];
      for (int c = 0; c < kI; ++c) y[c] = load(s.rows[i].right[c]);
      for (int u = 0; u < s.usedCounts[i]; ++u) {
        const JointBelow& q = below[used[u]];
        const auto* scaled = s.scaled + q.at;
        auto* right = s.rows[q.to].right;
        withSize(s.shapes[q.to].size, [&](auto high) {
          constexpr int kR = decltype(high)::value;
          N sum[kR];
          for (int r = 0; r < kR; ++r) {
            sum[r] = load(scaled[r]) * y[0];
            for (int c = 1; c < kI; ++c) sum[r] = sum[r] + load(scaled[c * kR + r]) * y[c];
            sum[r] = load(right[r]) - sum[r];
          }
          for (int r = 0; r < kR; ++r) store(right[r], sum[r]);
        });
      }
    });
  }
  solveTail<N>(s);
  for (int i = s.tailStart; i-- > 0;) {
    if (!s.used[i]) continue;
    const JointBelow* below = s.below + s.columns[i].start;
    const int* used = s.usedBelow + s.columns[i].start;
    auto& row = s.rows[i];
    const auto* inverse = s.factors[i].inverse;
    withSize(s.shapes[i].size, [&](auto size) {
      constexpr int kI = decltype(size)::value;
      N y[kI];
      for (int r = 0; r < kI; ++r) {
        y[r] = load(inverse[symmetric(r, 0)]) * load(row.right[0]);
        for (int c = 1; c < kI; ++c) {
          y[r] = y[r] + load(inverse[symmetric(r, c)]) * load(row.right[c]);
        }
      }
      for (int u = 0; u < s.usedCounts[i]; ++u) {
        const JointBelow& q = below[used[u]];
        const auto* scaled = s.scaled + q.at;
        withSize(s.shapes[q.to].size, [&](auto high) {
          constexpr int kR = decltype(high)::value;
          for (int r = 0; r < kR; ++r) {
            const N right = load(s.rows[q.to].right[r]);
            for (int c = 0; c < kI; ++c) y[c] = y[c] - load(scaled[c * kR + r]) * right;
          }
        });
      }
      for (int c = 0; c < kI; ++c) store(row.right[c], y[c]);
    });
  }
}

// u += M^-1 J^T right
template <class N>
void give(const Of<N>& s) {
  for (int i = 0; i < s.rowCount; ++i) {
    if (!s.used[i]) continue;
    const JointShape& shape = s.shapes[i];
    auto& row = s.rows[i];
    const Triple<N> change = load3<N>(row.right);
    const N parts[3] = {change.x, change.y, change.z};
    const auto& response = s.factors[i].response;
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      auto& body = s.bodies[shape.body[b]];
      const N m = load(body.inverseMass);
      Triple<N> u = load3<N>(body.u), theta = load3<N>(body.theta);
      if (shape.isGap) u = b == 0 ? u + change * m : u - change * m;
      for (int r = 0; r < shape.rows; ++r) {
        if (shape.hasLinear) u = u + load3<N>(row.linear[b] + 3 * r) * (m * parts[r]);
        if (shape.hasAngular) theta = theta + load3<N>(response[b] + 3 * r) * parts[r];
      }
      store3(body.u, u);
      store3(body.theta, theta);
    }
  }
}

template <class N>
void follow(const Of<N>& s) {
  for (int i = 0; i < s.rowCount; ++i) {
    if (!s.used[i]) continue;
    auto& row = s.rows[i];
    const Triple<N> t = along<N>(s, i, [](const auto& body, auto& u, auto& theta) {
      u = load3<N>(body.u);
      theta = load3<N>(body.theta);
    });
    const N zero = all<N>(0), free = load(row.free);
    store(row.right[0], wherePositive(free, zero - t.x, zero));
    store(row.right[1], wherePositive(free, zero - t.y, zero));
    store(row.right[2], wherePositive(free, zero - t.z, zero));
  }
  substitute<N>(s);
  give<N>(s);
}

template <class N>
void apply(const Of<N>& s) {
  for (int i = 0; i < s.rowCount; ++i) {
    if (!s.used[i]) continue;
    auto& row = s.rows[i];
    store3(row.lambda, load3<N>(row.lambda) + load3<N>(row.right));
  }
  give<N>(s);
  for (int i = 0; i < *s.tail.count; ++i) {
    store(s.rows[s.tailStart + s.tail.places[i]].free, load(s.tail.free[i]));
  }
}

// The records of the lanes of body i.
template <int W>
void motionsOf(const JointContacts& of, int i, float* (&motions)[W], float* (&before)[W]) {
  for (int l = 0; l < W; ++l) {
    motions[l] = of.motions[of.slots[i * W + l]].u;
    before[l] = of.before[of.slots[i * W + l]].u;
  }
}
template <class N>
void loadRoots(const JointContacts& of, int i, N (&root)[6]) {
  const float* roots[N::kWidth];
  for (int l = 0; l < N::kWidth; ++l) roots[l] = of.masses[of.slots[i * N::kWidth + l]].root;
  loadSix(roots, root);
}

template <class N>
void takeContacts(const Of<N>& s, const JointContacts& of) {
  constexpr int kWidth = N::kWidth;
  for (int i = 0; i < s.bodyCount; ++i) {
    if (!of.moves[i]) continue;
    float *motions[kWidth], *before[kWidth];
    motionsOf(of, i, motions, before);
    N now[6], then[6], root[6];
    loadSix(motions, now);
    loadSix(before, then);
    loadRoots(of, i, root);
    storeSix(now, before, of.lanes);
    for (int k = 0; k < 6; ++k) now[k] = now[k] - then[k];
    auto& body = s.bodies[i];
    store3<N>(body.u, load3<N>(body.u) + Triple<N>{now[0], now[1], now[2]});
    const Triple<N> theta = load3<N>(body.theta);
    const Triple<N> turned =
        theta + Triple<N>{root[0] * now[3], root[1] * now[3] + root[3] * now[4],
                          root[2] * now[3] + root[4] * now[4] + root[5] * now[5]};
    const N turns = load(body.inertia[0]) + load(body.inertia[1]) + load(body.inertia[2]);
    storeWhere3(turns, body.theta, turned);
  }
}

template <class N>
void tellContacts(const Of<N>& s, const JointContacts& of) {
  constexpr int kWidth = N::kWidth;
  const N one = all<N>(1), zero = all<N>(0);
  for (int i = 0; i < s.bodyCount; ++i) {
    if (!of.moves[i]) continue;
    float *motions[kWidth], *before[kWidth];
    motionsOf(of, i, motions, before);
    N root[6];
    loadRoots(of, i, root);
    const N i00 = one / root[0], i11 = one / root[3], i22 = one / root[5];
    const N i10 = (zero - root[1]) * i00 * i11, i21 = (zero - root[4]) * i11 * i22;
    const N i20 = (zero - (root[2] * i00 + root[4] * i10)) * i22;
    const auto& body = s.bodies[i];
    const Triple<N> u = load3<N>(body.u), theta = load3<N>(body.theta);
    const N now[6] = {u.x,
                      u.y,
                      u.z,
                      i00 * theta.x,
                      i10 * theta.x + i11 * theta.y,
                      i20 * theta.x + i21 * theta.y + i22 * theta.z};
    storeSix(now, motions, of.lanes);
    storeSix(now, before, of.lanes);
  }
}

template <class N>
constexpr JointKernels<N::kWidth> tableOf() {
  return {place<N>,        turnBack<N>,     seeGaps<N>,      seeLimits<N>,       begin<N>,
          chooseLimits<N>, keepCarrying<N>, stiffen<N>,      factorize<N>,       findChanged<N>,
          respondAll<N>,   aimAtErrors<N>,  findOpen<N>,     aimAtVelocities<N>, substitute<N>,
          follow<N>,       apply<N>,        takeContacts<N>, tellContacts<N>};
}

}  // namespace
}  // namespace physics
