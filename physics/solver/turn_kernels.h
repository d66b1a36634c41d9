// The kernel of turn_block.h, for the two files that compile it. KERNELS names the table.
#include "physics/solver/lanes.h"
#include "physics/solver/turn_block.h"

namespace physics {
namespace {

inline Lanes load(const Eight& p) { return load(p.v); }
inline void store(Eight& p, Lanes a) { store(p.v, a); }
inline Lanes3 load3(const Eight* p) { return {load(p[0]), load(p[1]), load(p[2])}; }
inline void store3(Eight* p, const Lanes3& a) {
  store(p[0], a.x);
  store(p[1], a.y);
  store(p[2], a.z);
}
inline Lanes3 where(Lanes test, const Lanes3& a) {
  const Lanes zero = all(0);
  return {wherePositive(test, a.x, zero), wherePositive(test, a.y, zero),
          wherePositive(test, a.z, zero)};
}
inline Lanes differ(Lanes a, Lanes b) {
  return wherePositive(a - b, all(1), wherePositive(b - a, all(1), all(0)));
}

constexpr int triangle(int r, int c) { return r * (r + 1) / 2 + c; }

inline const TurnGap& gapOf(const TurnView& s, int i) {
  return *reinterpret_cast<const TurnGap*>(s.numbers + s.rows[i].numbers);
}
inline const Eight* blocksOf(const TurnView& s, int i) {
  return s.numbers + s.rows[i].numbers + sizeof(TurnGap) / sizeof(Eight);
}

inline void gatherBodies(const TurnView& s, const LaneMotion* motions) {
  const Lanes3 none = {all(0), all(0), all(0)};
  for (int i = 0; i < s.bodyCount; ++i) {
    const TurnBody& body = s.bodies[i];
    TurnMotion& to = s.motions[i];
    Lanes r[8];
    for (int l = 0; l < 8; ++l) r[l] = load(motions[body.slot[l]].u);
    transpose(r);
    store3(to.u, {r[0], r[1], r[2]});
    const Eight* root = body.root;
    store3(to.theta, {load(root[0]) * r[3], load(root[1]) * r[3] + load(root[3]) * r[4],
                      load(root[2]) * r[3] + load(root[4]) * r[4] + load(root[5]) * r[5]});
    store3(to.push, none);
    store3(to.torque, none);
  }
}

inline void scatterBodies(const TurnView& s, LaneMotion* motions) {
  for (int i = 0; i < s.bodyCount; ++i) {
    const TurnBody& body = s.bodies[i];
    const TurnMotion& from = s.motions[i];
    const Lanes mass = load(body.inverseMass);
    const Lanes3 u = load3(from.u) + load3(from.push) * mass, torque = load3(from.torque);
    const unsigned moves = positive(mass);
    Lanes r[8];
    for (int l = 0; l < 8; ++l) r[l] = load(motions[body.slot[l]].u);
    transpose(r);
    r[0] = u.x, r[1] = u.y, r[2] = u.z;
    for (int k = 0; k < 3; ++k) r[3 + k] = r[3 + k] + dot(load3(body.given + 3 * k), torque);
    transpose(r);
    for (int l = 0; l < 8; ++l) {
      if (moves >> l & 1) store(motions[body.slot[l]].u, r[l]);
    }
  }
}

inline void aim(const TurnView& s) {
  const Lanes3 none = {all(0), all(0), all(0)};
  for (int i = 0; i < s.gapCount; ++i) {
    const TurnGap& gap = gapOf(s, i);
    Lanes3 error = load3(gap.off) + load3(s.lambda + 3 * i) * load(gap.yields);
    if (const int a = s.rows[i].body[0]; a >= 0) {
      error = error + load3(s.motions[a].u) + cross(load3(gap.arm[0]), load3(s.motions[a].theta));
    }
    if (const int b = s.rows[i].body[1]; b >= 0) {
      error = error - load3(s.motions[b].u) + cross(load3(gap.arm[1]), load3(s.motions[b].theta));
    }
    store3(s.right + 3 * i, where(load(gap.free), none - error));
  }
  for (int k = 0; k < s.limitCount; ++k) {
    const TurnLimit& limit = s.limits[k];
    const int* body = s.rows[s.gapCount + k].body;
    const int place = 3 * s.gapCount + k;
    const Lanes3 a = body[0] >= 0 ? load3(s.motions[body[0]].theta) : none;
    const Lanes3 b = body[1] >= 0 ? load3(s.motions[body[1]].theta) : none;
    const Lanes error = load(limit.off) + load(s.lambda[place]) * load(limit.yields) +
                        dot(load3(limit.gradient), b - a);
    store(s.right[place], wherePositive(load(limit.free), all(0) - error, all(0)));
  }
}

inline void eliminateGaps(const TurnView& s) {
  for (int i = 0; i < s.gapCount; ++i) {
    const Lanes3 y = load3(s.right + 3 * i);
    const Eight* block = blocksOf(s, i);
    const int* below = s.below + s.rows[i].below;
    for (int k = 0; k < s.rows[i].belowCount; ++k) {
      Eight* right = s.right + below[k];
      const int size = below[k] < 3 * s.gapCount ? 3 : 1;
      for (int r = 0; r < size; ++r, block += 3) {
        store(right[r], load(right[r]) - dot(load3(block), y));
      }
    }
  }
}

inline void substituteGaps(const TurnView& s) {
  for (int i = s.gapCount; i-- > 0;) {
    const TurnGap& gap = gapOf(s, i);
    const Lanes3 x = load3(s.right + 3 * i);
    const Lanes b = load(gap.inverse[1]), d = load(gap.inverse[3]), e = load(gap.inverse[4]);
    Lanes3 y = {load(gap.inverse[0]) * x.x + b * x.y + d * x.z,
                b * x.x + load(gap.inverse[2]) * x.y + e * x.z,
                d * x.x + e * x.y + load(gap.inverse[5]) * x.z};
    const Eight* block = blocksOf(s, i);
    const int* below = s.below + s.rows[i].below;
    for (int k = 0; k < s.rows[i].belowCount; ++k) {
      const Eight* right = s.right + below[k];
      const int size = below[k] < 3 * s.gapCount ? 3 : 1;
      for (int r = 0; r < size; ++r, block += 3) y = y - load3(block) * load(right[r]);
    }
    store3(s.right + 3 * i, y);
  }
}

// L and D^-1 of the limits that are free, 1 on the diagonal of the others.
inline void factorizeTail(const TurnView& s) {
  for (int i = 0; i < s.limitCount; ++i) {
    const Lanes free = load(s.limits[i].free);
    Eight* row = s.factor + triangle(i, 0);
    const Eight* entries = s.tail + triangle(i, 0);
    for (int j = 0; j < i; ++j) {
      const Lanes both = wherePositive(free, load(s.limits[j].free), all(0));
      Lanes sum = wherePositive(both, load(entries[j]), all(0));
      const Eight* other = s.factor + triangle(j, 0);
      for (int k = 0; k < j; ++k) sum = sum - load(row[k]) * load(other[k]);
      store(row[j], sum);  // L_ij D_j for now
    }
    Lanes d = wherePositive(free, load(entries[i]), all(1));
    for (int j = 0; j < i; ++j) {
      const Lanes scaled = load(row[j]), l = scaled * load(s.factor[triangle(j, j)]);
      d = d - scaled * l;
      store(row[j], l);
    }
    store(row[i], all(1) / d);
  }
  *s.isFactored = true;
}

// x = A^-1 of what is aimed at, less what the limits that were held give up.
inline void solveTailOnce(const TurnView& s, Eight* x) {
  const int n = s.limitCount;
  for (int i = 0; i < n; ++i) {
    Lanes sum = load(s.right[3 * s.gapCount + i]);
    for (int j = 0; j < n; ++j) {
      if (!s.gives[j]) continue;
      sum = sum - load(s.tail[i > j ? triangle(i, j) : triangle(j, i)]) * load(s.held[j]);
    }
    sum = wherePositive(load(s.limits[i].free), sum, all(0));
    const Eight* row = s.factor + triangle(i, 0);
    for (int j = 0; j < i; ++j) sum = sum - load(row[j]) * load(x[j]);
    store(x[i], sum);
  }
  for (int i = 0; i < n; ++i) store(x[i], load(x[i]) * load(s.factor[triangle(i, i)]));
  for (int i = n; i-- > 0;) {
    const Lanes xi = load(x[i]);
    const Eight* row = s.factor + triangle(i, 0);
    for (int j = 0; j < i; ++j) store(x[j], load(x[j]) - load(row[j]) * xi);
  }
}

// Limits that the solution would take past a bound are held there. False: there are none.
inline bool holdAtBounds(const TurnView& s, const Eight* x) {
  bool any = false;
  const Lanes zero = all(0);
  for (int i = 0; i < s.limitCount; ++i) {
    TurnLimit& limit = s.limits[i];
    const Lanes lambda = load(s.lambda[3 * s.gapCount + i]), wanted = lambda + load(x[i]);
    const Lanes inside = smaller(larger(wanted, load(limit.low)), load(limit.high));
    const Lanes free = load(limit.free);
    const Lanes holds = wherePositive(free, differ(inside, wanted), zero);
    if (positive(holds) == 0) continue;
    any = true;
    s.gives[i] = 1;
    store(s.held[i], wherePositive(holds, inside - lambda, load(s.held[i])));
    store(limit.free, wherePositive(holds, zero, free));
  }
  return any;
}

// Each round holds one more in every lane that goes on, so that there are no more than there are
// limits.
inline void solveTail(const TurnView& s) {
  Eight* const x = s.held + s.limitCount;
  for (int i = 0; i < s.limitCount; ++i) {
    store(s.held[i], all(0));
    s.gives[i] = 0;
  }
  do {
    if (!*s.isFactored) factorizeTail(s);
    solveTailOnce(s, x);
    *s.isFactored = !holdAtBounds(s, x);
  } while (!*s.isFactored);
  for (int i = 0; i < s.limitCount; ++i) {
    store(s.right[3 * s.gapCount + i],
          wherePositive(load(s.limits[i].free), load(x[i]), load(s.held[i])));
  }
}

inline void give(const TurnView& s) {
  for (int i = 0; i < s.gapCount; ++i) {
    const TurnGap& gap = gapOf(s, i);
    const Lanes3 change = load3(s.right + 3 * i);
    store3(s.lambda + 3 * i, load3(s.lambda + 3 * i) + change);
    if (const int a = s.rows[i].body[0]; a >= 0) {
      TurnMotion& to = s.motions[a];
      store3(to.push, load3(to.push) + change);
      store3(to.torque, load3(to.torque) + cross(change, load3(gap.arm[0])));
    }
    if (const int b = s.rows[i].body[1]; b >= 0) {
      TurnMotion& to = s.motions[b];
      store3(to.push, load3(to.push) - change);
      store3(to.torque, load3(to.torque) + cross(change, load3(gap.arm[1])));
    }
  }
  for (int k = 0; k < s.limitCount; ++k) {
    const int* body = s.rows[s.gapCount + k].body;
    const int place = 3 * s.gapCount + k;
    const Lanes change = load(s.right[place]);
    store(s.lambda[place], load(s.lambda[place]) + change);
    const Lanes3 torque = load3(s.limits[k].gradient) * change;
    if (body[0] >= 0) {
      store3(s.motions[body[0]].torque, load3(s.motions[body[0]].torque) - torque);
    }
    if (body[1] >= 0) {
      store3(s.motions[body[1]].torque, load3(s.motions[body[1]].torque) + torque);
    }
  }
}

void follow(const TurnView& s, LaneMotion* motions) {
  gatherBodies(s, motions);
  aim(s);
  eliminateGaps(s);
  solveTail(s);
  substituteGaps(s);
  give(s);
  scatterBodies(s, motions);
}

}  // namespace

const TurnKernels KERNELS = {follow};

}  // namespace physics
