// Articulations side by side: the same bytes in any lane, whatever registers, and whoever is
// beside.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>

#include "physics/constraints/pull_stiffness.h"
#include "physics/solver/joint_lanes.h"
#include "physics/solver/joint_topology.h"
#include "physics/world.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

Settings falling(bool touches = false) {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  if (touches) settings.contact = ContactSettings{};
  return settings;
}

// Three bodies, each joined to the next one by a ball and socket, a cone and a twist limit.
std::shared_ptr<const JointTopology> threeLinks() {
  std::vector<JointRef> refs;
  std::vector<JointKind> kinds;
  for (const BodyId first : {1, 2}) {
    for (const JointSeen seen : {JointSeen::kGap, JointSeen::kCone, JointSeen::kTwist}) {
      JointKind kind;
      kind.bodyCount = 2;
      kind.rows = seen == JointSeen::kGap ? 3 : 1;
      kind.bodies = {first, first + 1};
      kind.seen = seen;
      kind.hasAngular = true;
      kind.pulls = seen == JointSeen::kGap;
      refs.push_back({static_cast<int>(seen), first});
      kinds.push_back(kind);
    }
  }
  const std::vector<BodyId> bodies = {1, 2, 3};
  const std::vector<InverseMass> masses(4, InverseMass{1, Mat3::Identity()});
  JointTopologies known;
  return topologyOf(refs, kinds, bodies, masses, known);
}

template <int W>
struct Memory {
  std::shared_ptr<const JointTopology> topology = threeLinks();
  std::vector<JointBody<W>> bodies{3};
  std::vector<JointLanes<W>> rows{topology->shapes.size()};
  std::vector<JointFactor<W>> factors{rows.size()};
  std::vector<JointFactored<W>> factored{3};
  std::vector<Num<W>> entries = std::vector<Num<W>>(topology->lower), scaled = entries;
  Num<W> open, stale, odd;
  std::vector<char> used = std::vector<char>(rows.size(), 1);
  std::vector<int> usedBelow = std::vector<int>(topology->below.size()),
                   usedCounts{used.begin(), used.end()};
  std::vector<Num<W>> tail{10}, factor{10}, scratch{12};
  std::vector<char> gives{0, 0, 0, 0};
  std::vector<int> places{0, 0, 0, 0};
  int tailCount = 0;
  bool isFactored = false;
  std::vector<int> slots = std::vector<int>(3 * W);
  std::vector<LaneMotion> motions = std::vector<LaneMotion>(3 * W);
  std::vector<LaneStart> before = std::vector<LaneStart>(3 * W);
  std::vector<LaneMass> masses = std::vector<LaneMass>(3 * W);

  JointContacts contacts() {
    return {slots.data(), motions.data(), before.data(), masses.data(), topology->moves.data(), W};
  }
  JointView<W> view() {
    return {bodies.data(),
            rows.data(),
            factors.data(),
            factored.data(),
            entries.data(),
            scaled.data(),
            3,
            static_cast<int>(rows.size()),
            topology->tailStart,
            topology->shapes.data(),
            topology->columns.data(),
            topology->below.data(),
            topology->updatesAt.data(),
            topology->meetings.data(),
            &open,
            &stale,
            used.data(),
            usedBelow.data(),
            usedCounts.data(),
            {tail.data(), factor.data(), &scratch[0], &scratch[4], &scratch[8], gives.data(),
             places.data(), &tailCount, &isFactored, topology->tail.data(),
             static_cast<int>(topology->tail.size())}};
  }
  // Lane l is a pose, a motion and limits of its own.
  void fill(int l, unsigned seed) {
    std::mt19937 random(seed);
    const auto next = [&] { return random() / 4294967296.0 - 0.5; };
    open.v[l] = stale.v[l] = 1;
    odd.v[l] = seed % 2;
    for (JointBody<W>& body : bodies) {
      body.startQ[0].v[l] = 1;
      for (int k = 0; k < 3; ++k) {
        body.startX[k].v[l] = next();
        body.u[k].v[l] = 0.01 * next();
        body.theta[k].v[l] = (seed == 3 ? 2 : 0.02) * next();  // one turns far
        body.inertia[k].v[l] = 5 + next();
      }
      body.inverseMass.v[l] = 1;
    }
    for (JointLanes<W>& row : rows) {
      for (Num<W>& fixed : row.fixed) fixed.v[l] = next();
      row.free.v[l] = 1;
    }
    for (int i = 0; i < 3; ++i) {  // slots the other way round
      const int slot = slots[i * W + l] = 3 * W - 1 - (i * W + l);
      for (int k = 0; k < 3; ++k) {
        before[slot].u[k] = static_cast<float>(0.01 * next());
        before[slot].turn[k] = static_cast<float>(0.01 * next());
        motions[slot].u[k] = static_cast<float>(0.01 * next());
        motions[slot].turn[k] = static_cast<float>(0.01 * next());
      }
      Mat3 root = Mat3::Zero();
      root << 1 + next(), 0, 0, next(), 1 + next(), 0, next(), next(), 1 + next();
      masses[slot] = laneMassOf({1, root * root.transpose()});
    }
  }
  void work(const JointKernels<W>& kernels) {
    const JointView<W> s = view();
    kernels.place(s);
    kernels.turnBack(s);
    kernels.seeGaps(s, true);
    kernels.seeLimits(s, true);
    kernels.begin(s);
    kernels.chooseLimits(s);
    kernels.factorize(s);
    kernels.takeContacts(s, contacts());
    kernels.aimAtErrors(s);
    kernels.substitute(s);
    kernels.apply(s);
    kernels.tellContacts(s, contacts());
    kernels.seeLimits(s, false);
    bool changed[W];
    kernels.keepCarrying(s, changed);
    kernels.findChanged(s, changed);
    kernels.respond(s);
    kernels.aimAtVelocities(s);
    kernels.substitute(s);
    kernels.apply(s);
    stale = odd;  // the other lanes keep what they have
    kernels.factorize(s);
    kernels.aimAtVelocities(s);
    kernels.substitute(s);
    kernels.apply(s);
    kernels.stiffen(s);
  }
};

TEST(JointKernels, GiveTheSameBytesInAnyRegisters) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2 here";
  Memory<4> wide, halves;
  for (int l = 0; l < 4; ++l) {
    wide.fill(l, l);
    halves.fill(l, l);
  }
  wide.work(kJointKernelsAvx2Of4);
  halves.work(kJointKernelsSse2Of4);
  EXPECT_GT(std::abs(wide.rows[0].lambda[0].v[0]), 1e-6);  // there was something to solve
  EXPECT_EQ(std::memcmp(wide.bodies.data(), halves.bodies.data(), 3 * sizeof(JointBody<4>)), 0);
  EXPECT_EQ(std::memcmp(wide.motions.data(), halves.motions.data(), 12 * sizeof(LaneMotion)), 0);
}

template <int W>
void expectBytesOfOne() {
  Memory<W> wide;
  for (int l = 0; l < W; ++l) wide.fill(l, l);
  wide.work(jointKernels<W>());
  for (int l = 0; l < W; ++l) {
    Memory<1> one;
    one.fill(0, l);
    one.work(jointKernels<1>());
    for (int body = 0; body < 3; ++body) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(one.bodies[body].u[k].v[0], wide.bodies[body].u[k].v[l]) << l;
        EXPECT_EQ(one.bodies[body].theta[k].v[0], wide.bodies[body].theta[k].v[l]) << l;
      }
      for (int k = 0; k < 6; ++k) {
        EXPECT_EQ(one.bodies[body].stiffness[k].v[0], wide.bodies[body].stiffness[k].v[l]) << l;
      }
    }
  }
}

// As one body after the other would be told, physics/solver/lane_mass.h.
template <int W>
void expectContactsAsOneByOne() {
  Memory<W> memory;
  for (int l = 0; l < W; ++l) memory.fill(l, l);
  for (Num<W>& inertia : memory.bodies[1].inertia) inertia.v[W - 1] = 0;  // nothing turns that one
  Memory<W> one = memory;
  std::vector<LaneInverse> inverses;
  for (const LaneMass& mass : one.masses) inverses.push_back(inverseOf(mass));
  const LaneBodies lanes = {one.slots, one.motions, one.before, one.masses, inverses};
  const JointKernels<W>& kernels = jointKernels<W>();
  kernels.takeContacts(memory.view(), memory.contacts());
  for (std::size_t i = 0; i < one.slots.size(); ++i) {
    JointBody<W>& body = one.bodies[i / W];
    const int l = static_cast<int>(i % W);
    if (!one.topology->moves[i / W]) continue;
    Vec3 u = read(body.u, l), theta = read(body.theta, l);
    lanes.take(one.slots[i], u, body.inertia[0].v[l] > 0 ? &theta : nullptr);
    write(body.u, l, u);
    write(body.theta, l, theta);
  }
  const std::size_t size = one.bodies.size() * sizeof(JointBody<W>);
  EXPECT_EQ(std::memcmp(memory.bodies.data(), one.bodies.data(), size), 0);
  kernels.tellContacts(memory.view(), memory.contacts());
  for (std::size_t i = 0; i < one.slots.size(); ++i) {
    const JointBody<W>& body = one.bodies[i / W];
    const int l = static_cast<int>(i % W), slot = one.slots[i];
    if (!one.topology->moves[i / W]) continue;
    lanes.give(slot, read(body.u, l), read(body.theta, l));
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(memory.motions[slot].u[k], one.motions[slot].u[k]) << i;
      EXPECT_EQ(memory.motions[slot].turn[k], one.motions[slot].turn[k]) << i;
    }
    EXPECT_FALSE((LaneBodies{memory.slots, memory.motions, memory.before, memory.masses, inverses})
                     .isChanged(slot));
  }
}

TEST(JointKernels, TakeWhatContactsGiveAsOneByOne) {
  expectContactsAsOneByOne<1>();
  expectContactsAsOneByOne<4>();
  if (mostJointLanes() == 8) expectContactsAsOneByOne<8>();
}

TEST(JointKernels, StiffenByWhatAllGapsOfABodyPullWith) {
  Memory<1> memory;
  memory.fill(0, 1);
  memory.work(jointKernels<1>());
  std::array<Mat3, 3> sums;
  sums.fill(Mat3::Zero());
  for (std::size_t i = 0; i < memory.rows.size(); ++i) {
    const JointShape& shape = memory.topology->shapes[i];
    if (!shape.isGap) continue;
    for (int b = 0; b < 2; ++b) {
      const Vec3 lambda = read(memory.rows[i].lambda, 0);
      const Vec3 force = b == 0 ? lambda : -lambda;
      sums[shape.body[b]] += pullStiffness(force, read(memory.rows[i].arm[b], 0));
    }
  }
  for (int body = 0; body < 3; ++body) {
    if (!memory.topology->moves[body]) sums[body].setZero();
    const Mat3 got = readSymmetric(memory.bodies[body].stiffness, 0);
    EXPECT_LT((got - sums[body]).norm(), 1e-12 * (1 + sums[body].norm())) << body;
  }
  EXPECT_GT(sums[1].norm() + sums[2].norm() + sums[0].norm(), 1e-6);  // something pulls
}

TEST(JointKernels, GiveALaneTheBytesThatItHasAlone) { expectBytesOfOne<4>(); }

TEST(JointKernels, GiveALaneOfEightTheBytesThatItHasAlone) {
  if (mostJointLanes() < 8) GTEST_SKIP() << "no AVX-512 here";
  expectBytesOfOne<8>();
}

// A trunk and two limbs with limits, thrown by its own number.
void addFigure(World& world, int number) {
  BodyId bodies[3];
  for (int k = 0; k < 3; ++k) {
    bodies[k] = addBody(world, Capsule{0.1, 0.4}, Vec3(20.0 * number, 1 + 0.6 * k, 0), 1 + k);
  }
  for (int k = 0; k < 2; ++k) {
    BallSocketDef ball;
    ball.bodies = {bodies[k], bodies[k + 1]};
    ball.at = Vec3(20.0 * number, 1.3 + 0.6 * k, 0);
    ConeLimitDef cone;
    cone.bodies = ball.bodies;
    cone.axis = Vec3::UnitY();
    cone.angle = 0.4;
    TwistLimitDef twist;
    twist.bodies = ball.bodies;
    twist.axis = Vec3::UnitY();
    twist.range = {-0.2, 0.3};
    world.add(ball);
    world.add(cone);
    world.add(twist);
  }
  world.setVelocity(bodies[number % 3], {Vec3(number, 3, -1), Vec3(2, 5 - number, number)});
}

// So many figures, each as it goes alone.
void expectAlone(int figures, bool onGround) {
  const auto start = [&](World& world) {
    if (onGround) addGround(world);
    return world.bodies().size();
  };
  World together(falling(onGround));
  const BodyId first = start(together);
  for (int number = 0; number < figures; ++number) addFigure(together, number);
  run(together, 120);
  for (int number = 0; number < figures; ++number) {
    World alone(falling(onGround));
    start(alone);
    addFigure(alone, number);
    run(alone, 120);
    for (BodyId k = 0; k < 3; ++k) {
      expectSameBytes(alone, first + k, together, first + 3 * number + k);
    }
  }
}

TEST(Articulations, DoNotKnowWhoIsBesideThem) { expectAlone(6, false); }

// Where contacts and joints take turns: eight side by side and five, and eight and three.
TEST(Articulations, DoNotKnowWhoTakesTurnsBesideThem) {
  expectAlone(13, true);
  expectAlone(11, true);
}

}  // namespace
}  // namespace physics::testing
