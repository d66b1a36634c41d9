// Kinds of constraints and forces as rows of an articulation.
#include "physics/solver/joint_row.h"

#include "physics/base/inverse.h"

namespace physics {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

template <class C>
constexpr bool kFits = C::kBodies != kMany&& C::kBodies <= JointRow::kMostBodies;

template <class C>
void takeGradients(const C& item, const Evaluated<C>& row, const Configuration& at,
                   JointRow& joint) {
  constexpr int kRows = C::kRows;
  for (int b = 0; b < C::kBodies; ++b) {
    if constexpr (C::kLinear) joint.linear[b].template topRows<kRows>() = row.linear[b];
    if constexpr (isAngular<C>()) joint.angular[b].template topRows<kRows>() = row.angular[b];
    if constexpr (requires { item.anchors; }) {
      joint.arm[b] = at.now[item.bodies[b]].q * item.anchors[b];
    }
  }
}

// J u + K^-1 lambda = K^-1 f; what does not fall off at all is a load.
template <class C>
void takeForce(const Evaluated<C>& push, JointRow& joint) {
  constexpr int kRows = C::kRows;
  joint.longest = push.longest;
  if (!(push.k.trace() > 0)) {
    joint.role = JointRow::Role::kLoad;
    joint.c.template head<kRows>() = push.f;
    return;
  }
  joint.role = JointRow::Role::kForce;
  const Eigen::Matrix<double, kRows, kRows> compliance = complianceOf(push.k);
  joint.alpha.template topLeftCorner<kRows, kRows>() = compliance;
  joint.c.template head<kRows>() = -(compliance * push.f);
}

template <class C>
void evaluateItem(const C& item, const Configuration& at, JointRow& joint) {
  if constexpr (kFits<C>) {
    constexpr int kRows = C::kRows;
    Evaluated<C> row;
    item.evaluate(at, row);
    joint.active = row.active;
    if (!row.active) return;
    joint.alpha.setZero();
    joint.c.setZero();
    joint.low = -kNoBound;
    joint.high = kNoBound;
    joint.longest = kNoBound;
    takeGradients(item, row, at, joint);
    if constexpr (Force<C>) {
      takeForce<C>(row, joint);
    } else {
      joint.role = JointRow::Role::kConstraint;
      joint.c.template head<kRows>() = row.c;
      joint.alpha.template topLeftCorner<kRows, kRows>().diagonal().setConstant(row.alpha);
      joint.low = row.low;
      joint.high = row.high;
      joint.longest = row.longest;
    }
  }
}

void put(const Vec3& v, double* to) { std::copy(v.data(), v.data() + 3, to); }

void fix(const BallSocket& item, JointKind& to) {
  to.seen = JointSeen::kGap;
  put(item.anchors[0], &to.fixed[0]);
  put(item.anchors[1], &to.fixed[3]);
}

void fix(const ConeLimit& item, JointKind& to) {
  to.seen = JointSeen::kCone;
  put(item.axes[0], &to.fixed[0]);
  put(item.axes[1], &to.fixed[3]);
  to.fixed[6] = item.angle;
  to.fixed[7] = sineCosine(item.angle).cosine;
}

void fix(const TwistLimit& item, JointKind& to) {
  const Quat& q = item.reference;
  const SineCosine low = sineCosine(0.5 * item.low), high = sineCosine(0.5 * item.high);
  to.seen = JointSeen::kTwist;
  put(item.axisI, &to.fixed[0]);
  to.fixed[3] = q.w();
  put(q.vec(), &to.fixed[4]);
  to.fixed[7] = item.low;
  to.fixed[8] = item.high;
  to.fixed[9] = low.sine / low.cosine;
  to.fixed[10] = high.sine / high.cosine;
}

template <class K>
JointKind describe(const K& kind, int index) {
  using C = typename K::Item;
  JointKind result;
  if constexpr (kFits<C>) {
    const C& item = kind.set.items[index];
    result.rows = C::kRows;
    result.bodyCount = C::kBodies;
    if constexpr (requires { fix(item, result); }) fix(item, result);
    result.hasLinear = C::kLinear && result.seen != JointSeen::kGap;
    result.hasAngular = isAngular<C>();
    result.pulls = requires { item.anchors; };
    result.isForce = Force<C>;
    result.stands = Force<C> || canStand<C>();
    result.regularisation = Force<C> ? 0 : kind.set.tuned[index].regularisation;
    for (int b = 0; b < C::kBodies; ++b) {
      result.bodies[b] = item.bodies[b];
    }
  }
  return result;
}

template <class K>
Multiplier read(const K& kind, int index) {
  Multiplier result;
  result.total.template head<K::Item::kRows>() = kind.set.lambda[index].total;
  result.dt = kind.set.lambda[index].step;
  return result;
}

template <class K>
void write(K& kind, int index, const Vec3& lambda, double dt) {
  kind.set.lambda[index].total = lambda.template head<K::Item::kRows>();
  kind.set.lambda[index].step = dt;
}

template <class C>
Nature natureOfItem(const C& item) {
  if constexpr (!kFits<C>) return Nature::kOther;
  if constexpr (Force<C>) return Nature::kForce;
  if constexpr (!canStand<C>()) return Nature::kOther;
  if (isEquality(item)) return Nature::kEquality;
  if constexpr (requires { item.isOneSided(); }) {
    if (item.isOneSided()) return Nature::kOneSided;
  }
  return Nature::kOther;
}

struct Calls {
  Nature (*nature)(const Kinds&, int);
  JointKind (*describe)(const Kinds&, int);
  void (*evaluate)(const Kinds&, int, const Configuration&, JointRow&);
  Multiplier (*read)(const Kinds&, int);
  void (*write)(Kinds&, int, const Vec3&, double);
};

template <std::size_t... I>
constexpr auto callsOf(std::index_sequence<I...>) {
  return std::array<Calls, sizeof...(I)>{Calls{
      [](const Kinds& kinds, int item) { return natureOfItem(std::get<I>(kinds).set.items[item]); },
      [](const Kinds& kinds, int item) { return describe(std::get<I>(kinds), item); },
      [](const Kinds& kinds, int item, const Configuration& at, JointRow& row) {
        evaluateItem(std::get<I>(kinds).set.items[item], at, row);
      },
      [](const Kinds& kinds, int item) { return read(std::get<I>(kinds), item); },
      [](Kinds& kinds, int item, const Vec3& lambda, double dt) {
        write(std::get<I>(kinds), item, lambda, dt);
      }}...};
}
constexpr auto kCalls = callsOf(std::make_index_sequence<std::tuple_size_v<Kinds>>{});

}  // namespace

Nature natureOf(const Kinds& kinds, JointRef ref) {
  return kCalls[ref.kind].nature(kinds, ref.item);
}

JointKind kindOf(const Kinds& kinds, JointRef ref) {
  return kCalls[ref.kind].describe(kinds, ref.item);
}

void evaluateRow(const Kinds& kinds, JointRef ref, const Configuration& at, JointRow& row) {
  kCalls[ref.kind].evaluate(kinds, ref.item, at, row);
}

Multiplier readMultiplier(const Kinds& kinds, JointRef ref) {
  return kCalls[ref.kind].read(kinds, ref.item);
}

void writeMultiplier(Kinds& kinds, JointRef ref, const Vec3& lambda, double dt) {
  kCalls[ref.kind].write(kinds, ref.item, lambda, dt);
}

bool carries(const Kinds& kinds, JointRef ref) {
  return !readMultiplier(kinds, ref).total.isZero(0);
}

}  // namespace physics
