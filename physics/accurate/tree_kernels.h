// The kernels of tree_block.h, for the two files that compile them. KERNELS names their table.
#include "physics/accurate/tree_block.h"
#include "physics/solver/joint_numbers.h"

namespace physics {
namespace {

using Three = Triple<Four>;

Four whole(double a) { return all<Four>(a); }
Three wholes(const double (&a)[3]) { return {whole(a[0]), whole(a[1]), whole(a[2])}; }

struct Turn {
  Four w;
  Three v;
};

Turn loadTurn(const TreeNum (&q)[4]) { return {load(q[0]), load3<Four>(q + 1)}; }

// exp(theta). Within 1 rad what is left of the series is below 1e-18.
Turn exponential(const Three& theta) {
  const Four one = whole(1), squared = squaredNorm(theta), t = whole(0.25) * squared;
  constexpr int kTerms = 8;
  Four sine = one, cosine = one;
  for (int k = kTerms; k > 0; --k) {
    cosine = one - t * whole(1.0 / (2 * k * (2 * k - 1))) * cosine;
    sine = one - t * whole(1.0 / (2 * k * (2 * k + 1))) * sine;
  }
  Turn turn = {cosine, theta * (whole(0.5) * sine)};
  if (!anyPositive(squared - one)) return turn;
  TreeNum way, angles[3], parts[4];
  store(way, squared);
  store3(angles, theta);
  store(parts[0], turn.w);
  store3(parts + 1, turn.v);
  for (int l = 0; l < kTreeLanes; ++l) {
    if (!(way.v[l] > 1)) continue;
    double q[4];
    turnFar({angles[0].v[l], angles[1].v[l], angles[2].v[l]}, q);
    for (int k = 0; k < 4; ++k) parts[k].v[l] = q[k];
  }
  return loadTurn(parts);
}

Turn turned(const Three& theta, const Turn& q) {
  const Turn e = exponential(theta);
  return {e.w * q.w - dot(e.v, q.v), q.v * e.w + e.v * q.w + cross(e.v, q.v)};
}

// An axis of the body in the world.
Three axisOf(const Turn& q, int axis) {
  const Four two = whole(2), one = whole(1);
  const Four x = q.v.x, y = q.v.y, z = q.v.z, w = q.w;
  if (axis == 0) {
    return {one - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)};
  }
  if (axis == 1) {
    return {two * (x * y - w * z), one - two * (x * x + z * z), two * (y * z + w * x)};
  }
  return {two * (x * z + w * y), two * (y * z - w * x), one - two * (x * x + y * y)};
}

void drift(const TreeView& s, const TreeNum& step) {
  const Four h = load(step);
  for (int i = 0; i < s.motionCount; ++i) {
    TreeMotion& motion = s.motion[i];
    const Turn q = turned(load3<Four>(motion.omega) * h, loadTurn(motion.q));
    const Four scale = whole(1.5) - whole(0.5) * (q.w * q.w + squaredNorm(q.v));
    store(motion.q[0], q.w * scale);
    store3(motion.q + 1, q.v * scale);
  }
}

struct Columns {
  Three x, y, z;
};
Columns loadColumns(const TreeNum (*m)[3]) {
  return {load3<Four>(m[0]), load3<Four>(m[1]), load3<Four>(m[2])};
}
Columns loadColumns(const TreeNum* m) {
  return {load3<Four>(m), load3<Four>(m + 3), load3<Four>(m + 6)};
}
void storeColumns(TreeNum* m, const Columns& a) {
  store3(m, a.x);
  store3(m + 3, a.y);
  store3(m + 6, a.z);
}
Three operator*(const Columns& m, const Three& a) { return m.x * a.x + m.y * a.y + m.z * a.z; }
Columns operator*(const Columns& a, const Columns& b) { return {a * b.x, a * b.y, a * b.z}; }
Columns operator-(const Columns& a, const Columns& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Columns operator+(const Columns& a, const Columns& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

Columns inverse(const Columns& m) {
  const Three a = cross(m.y, m.z), b = cross(m.z, m.x), c = cross(m.x, m.y);
  const Four scale = whole(1) / dot(m.x, a);
  return {Three{a.x, b.x, c.x} * scale, Three{a.y, b.y, c.y} * scale, Three{a.z, b.z, c.z} * scale};
}

// I alpha = t - omega x I (omega + h/2 alpha) - h/2 alpha x I omega
void prepare(const TreeBody& body, const TreeMotion& motion, Four half, TreeTurn& turn) {
  const Turn q = loadTurn(motion.q);
  const Columns axis = {axisOf(q, 0), axisOf(q, 1), axisOf(q, 2)};
  const Three a = axis.x * whole(body.inertia[0]), b = axis.y * whole(body.inertia[1]),
              c = axis.z * whole(body.inertia[2]);
  const Columns inertia = {a * axis.x.x + b * axis.y.x + c * axis.z.x,
                           a * axis.x.y + b * axis.y.y + c * axis.z.y,
                           a * axis.x.z + b * axis.y.z + c * axis.z.z};
  const Three omega = load3<Four>(motion.omega), m = (inertia * omega) * half, w = omega * half;
  const Four zero = whole(0);
  const Columns yields = inverse({inertia.x + cross(w, inertia.x) - Three{zero, m.z, zero - m.y},
                                  inertia.y + cross(w, inertia.y) - Three{zero - m.z, zero, m.x},
                                  inertia.z + cross(w, inertia.z) - Three{m.y, zero - m.x, zero}});
  storeColumns(turn.axis[0], axis);
  storeColumns(turn.yields[0], yields);
  store3(turn.free, yields * (wholes(body.torque) - cross(omega, inertia * omega)));
}

// M [r]x
Columns turnedBy(const Columns& m, const Three& r) {
  return {m.y * r.z - m.z * r.y, m.z * r.x - m.x * r.z, m.x * r.y - m.y * r.x};
}

// What an end of a socket accelerates by without it.
Three lookAtEnd(const TreeView& s, const TreeBody& body, Four half, TreeJoint& joint, int b) {
  const Three pull = wholes(body.pull);
  if (body.turner < 0) return pull;
  const TreeTurn& turn = s.turns[body.turner];
  const Columns yields = loadColumns(turn.yields);
  const Three arm = loadColumns(turn.axis) * wholes(joint.anchor[b]);
  const Three omega = load3<Four>(s.motion[body.turner].omega), speed = cross(omega, arm);
  const auto at = [&](const Three& alpha) {
    return cross(alpha, arm) + (cross(omega, cross(alpha, arm)) + cross(alpha, speed)) * half;
  };
  store3(joint.arm[b], arm);
  storeColumns(joint.yields[b][0], {at(yields.x), at(yields.y), at(yields.z)});
  return pull + cross(omega, speed) + at(load3<Four>(turn.free));
}

// What end p of joint k accelerates by for a unit pull on end q of joint i, of the body they share.
Columns couple(const TreeView& s, int k, int p, int i, int q) {
  const TreeBody& body = s.bodies[s.shapes[i].body[q]];
  const Four mass = whole(body.mass), zero = whole(0);
  Columns sum = {{mass, zero, zero}, {zero, mass, zero}, {zero, zero, mass}};
  if (body.turner >= 0) {
    sum = sum + turnedBy(loadColumns(s.joints[k].yields[p]), load3<Four>(s.joints[i].arm[q]));
  }
  const Columns none = {{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
  return p == q ? sum : none - sum;
}

void build(const TreeView& s) {
  for (int i = 0; i < s.jointCount; ++i) {
    const JointShape& shape = s.shapes[i];
    const Four zero = whole(0);
    Columns sum = {{zero, zero, zero}, {zero, zero, zero}, {zero, zero, zero}};
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (shape.moves[b]) sum = sum + couple(s, i, b, i, b);
    }
    storeColumns(s.diagonal + 9 * i, sum);
    for (int n = 0; n < s.columns[i].count; ++n) {
      const JointBelow& below = s.below[s.columns[i].start + n];
      const JointMeeting& meeting = s.meetings[below.block];
      const int p = meeting.later[0], q = meeting.earlier[0];
      storeColumns(s.lower + 9 * below.block, couple(s, below.to, p, i, q));
      storeColumns(s.upper + 9 * below.block, couple(s, i, q, below.to, p));
    }
  }
}

// A block and what it acts on: three by three, of sockets, or one number, of links.
void get(const TreeNum* from, Columns& to) { to = loadColumns(from); }
void get(const TreeNum* from, Three& to) { to = load3<Four>(from); }
void get(const TreeNum* from, Four& to) { to = load(*from); }
void set(TreeNum* to, const Columns& a) { storeColumns(to, a); }
void set(TreeNum* to, const Three& a) { store3(to, a); }
void set(TreeNum* to, Four a) { store(*to, a); }
Four inverse(Four a) { return whole(1) / a; }
Four opposite(Four a) { return whole(0) - a; }
Three opposite(const Three& a) { return {opposite(a.x), opposite(a.y), opposite(a.z)}; }

template <class T>
T read(const TreeNum* from) {
  T to;
  get(from, to);
  return to;
}
template <class T>
void subtract(TreeNum* from, const T& what) {
  set(from, read<T>(from) - what);
}

// L D U, and lambda <- -A^-1 lambda.
template <class Block, class Vector>
void eliminate(const TreeView& s) {
  constexpr int kNumbers = sizeof(Block) / sizeof(Four);
  const auto at = [](TreeNum* blocks, int i) { return blocks + kNumbers * i; };
  for (int i = 0; i < s.jointCount; ++i) {
    const JointColumn& column = s.columns[i];
    const JointBelow* below = s.below + column.start;
    const Block pivot = inverse(read<Block>(at(s.diagonal, i)));
    const Vector right = read<Vector>(s.joints[i].lambda);
    set(at(s.diagonal, i), pivot);
    for (int q = 0; q < column.count; ++q) {
      const Block lower = read<Block>(at(s.lower, below[q].block)) * pivot;
      const Block upper = read<Block>(at(s.upper, below[q].block));
      set(at(s.lower, below[q].block), lower);
      subtract<Vector>(s.joints[below[q].to].lambda, lower * right);
      subtract<Block>(at(s.diagonal, below[q].to), lower * upper);
      const int* target = s.updates + column.updates + q * (q + 1) / 2;
      for (int p = 0; p < q; ++p) {
        subtract<Block>(at(s.lower, target[p]), lower * read<Block>(at(s.upper, below[p].block)));
        subtract<Block>(at(s.upper, target[p]), read<Block>(at(s.lower, below[p].block)) * upper);
      }
    }
  }
  for (int i = s.jointCount; i-- > 0;) {
    const JointColumn& column = s.columns[i];
    Vector y = read<Vector>(s.joints[i].lambda);
    for (int q = 0; q < column.count; ++q) {
      const JointBelow& below = s.below[column.start + q];
      // Those after it have the other sign already.
      y = y + read<Block>(at(s.upper, below.block)) * read<Vector>(s.joints[below.to].lambda);
    }
    set(s.joints[i].lambda, opposite(read<Block>(at(s.diagonal, i)) * y));
  }
}

void kickSockets(const TreeView& s, const TreeNum& step) {
  const Four h = load(step), half = whole(0.5) * h, zero = whole(0);
  for (int i = 0; i < s.bodyCount; ++i) {
    const int turner = s.bodies[i].turner;
    if (turner >= 0) prepare(s.bodies[i], s.motion[turner], half, s.turns[turner]);
  }
  for (int i = 0; i < s.jointCount; ++i) {
    const JointShape& shape = s.shapes[i];
    Three open = {zero, zero, zero};
    for (int b = 0; b < shape.bodyCount; ++b) {
      if (!shape.moves[b]) continue;
      const Three at = lookAtEnd(s, s.bodies[shape.body[b]], half, s.joints[i], b);
      open = b == 0 ? open + at : open - at;
    }
    store3(s.joints[i].lambda, open);
  }
  build(s);
  eliminate<Columns, Three>(s);
  // By what joints twist with.
  for (int i = 0; i < s.jointCount; ++i) {
    const JointShape& shape = s.shapes[i];
    const Three lambda = load3<Four>(s.joints[i].lambda);
    for (int b = 0; b < shape.bodyCount; ++b) {
      const int turner = s.bodies[shape.body[b]].turner;
      if (turner < 0) continue;
      TreeTurn& turn = s.turns[turner];
      const Three twist = cross(load3<Four>(s.joints[i].arm[b]), lambda);
      const Three more = loadColumns(turn.yields) * twist, free = load3<Four>(turn.free);
      store3(turn.free, b == 0 ? free + more : free - more);
    }
  }
  for (int i = 0; i < s.motionCount; ++i) {
    TreeNum* to = s.motion[i].omega;
    store3(to, load3<Four>(to) + load3<Four>(s.turns[i].free) * h);
  }
}

// A link's points part along it, u, by l omega^2: u . (a_1 - a_0) + l omega . (omega + h alpha) = 0
// with l alpha = u x (a_1 - a_0), and so J' = u + h omega x u.
void lookAtLinks(const TreeView& s, Four h) {
  for (int i = 0; i < s.jointCount; ++i) {
    TreeJoint& joint = s.joints[i];
    const Turn q = loadTurn(s.motion[i].q);
    const Three start = wholes(joint.anchor[0]), across = cross(q.v, start) * whole(2);
    const Three u = start + across * q.w + cross(q.v, across),
                omega = load3<Four>(s.motion[i].omega);
    const Three row = u + cross(omega, u) * h;
    store3(joint.arm[0], u);
    store3(joint.arm[1], row);
    const TreeBody &first = s.bodies[s.shapes[i].body[0]], &second = s.bodies[s.shapes[i].body[1]];
    store(joint.lambda[0], dot(row, wholes(second.pull) - wholes(first.pull)) +
                               squaredNorm(omega) * whole(joint.length));
    store(s.diagonal[i], dot(row, u) * whole(first.mass + second.mass));
  }
  for (int i = 0; i < s.jointCount; ++i) {
    const Three u = load3<Four>(s.joints[i].arm[0]), row = load3<Four>(s.joints[i].arm[1]);
    for (int n = 0; n < s.columns[i].count; ++n) {
      const JointBelow& below = s.below[s.columns[i].start + n];
      const JointMeeting& meeting = s.meetings[below.block];
      const int p = meeting.later[0], q = meeting.earlier[0];
      const double mass = s.bodies[s.shapes[i].body[q]].mass;
      const Four shared = whole(p == q ? mass : -mass);
      const TreeJoint& other = s.joints[below.to];
      store(s.lower[below.block], dot(load3<Four>(other.arm[1]), u) * shared);
      store(s.upper[below.block], dot(row, load3<Four>(other.arm[0])) * shared);
    }
  }
}

void kickLinks(const TreeView& s, const TreeNum& step) {
  const Four h = load(step);
  lookAtLinks(s, h);
  eliminate<Four, Four>(s);
  for (int i = 0; i < s.bodyCount; ++i) store3(s.alpha + 3 * i, wholes(s.bodies[i].pull));
  for (int i = 0; i < s.jointCount; ++i) {
    const Three pull = load3<Four>(s.joints[i].arm[0]) * load(s.joints[i].lambda[0]);
    for (int b = 0; b < 2; ++b) {
      const int body = s.shapes[i].body[b];
      const double mass = s.bodies[body].mass;
      store3(s.alpha + 3 * body,
             load3<Four>(s.alpha + 3 * body) + pull * whole(b == 1 ? mass : -mass));
    }
  }
  for (int i = 0; i < s.jointCount; ++i) {
    const int* body = s.shapes[i].body;
    const Three part = load3<Four>(s.alpha + 3 * body[1]) - load3<Four>(s.alpha + 3 * body[0]);
    const Three turn = cross(load3<Four>(s.joints[i].arm[0]), part);
    TreeNum* to = s.motion[i].omega;
    store3(to, load3<Four>(to) + turn * (h * whole(1 / s.joints[i].length)));
  }
}

}  // namespace

const TreeKernels KERNELS = {drift, kickSockets, kickLinks};

}  // namespace physics
