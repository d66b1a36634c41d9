// The default method: what holds without a word about methods.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "physics/base/rotation.h"
#include "physics/make/chain.h"
#include "physics/solver/contact_block.h"
#include "physics/solver/lane_mass.h"
#include "physics/world.h"
#include "physics/world/measure.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

Settings asByDefault() {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  return settings;
}

TEST(SmallSteps, HoldAWeightOfAThousandOnOne) {
  World world(asByDefault());
  addGround(world);
  addBody(world, Box{Vec3(1, 1, 1)}, Vec3(0, 0.5, 0), 1);
  const BodyId heavy = addBody(world, Box{Vec3(1, 1, 1)}, Vec3(0, 1.5, 0), 1000);
  run(world, 300);
  EXPECT_NEAR(world.bodies().pose[heavy].x.y(), 1.5, 1e-3);  // measured 3e-4
}

TEST(SmallSteps, KeepATowerOfThirtyBoxesUpright) {
  World world(asByDefault());
  addGround(world);
  const BodyId first = addStack(world, 30);
  run(world, 300);
  const Vec3 top = world.bodies().pose[first + 29].x;
  EXPECT_NEAR(top.y(), 29.5, 0.01);
  EXPECT_LT(std::hypot(top.x(), top.z()), 0.01);
}

// Nine contacts from layer to layer: sweeps would not find their loads in time, and it would sway
// by 14 mm at 8 cm/s.
TEST(SmallSteps, ATowerOfAHundredLayersOfPlanksStandsStillFromTheStart) {
  World world(asByDefault());
  addGround(world);
  std::vector<Vec3> at;
  for (int layer = 0; layer < 100; ++layer) {
    for (const double aside : {-0.5, 0.0, 0.5}) {
      const bool across = layer % 2 != 0;
      at.emplace_back(across ? aside : 0, 0.1 + 0.2 * layer, across ? 0 : aside);
      addBody(world, Box{across ? Vec3(0.3, 0.2, 1.5) : Vec3(1.5, 0.2, 0.3)}, at.back());
    }
  }
  const BodyId first = world.bodyCount() - static_cast<int>(at.size());
  run(world, 150);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const BodyId plank = first + static_cast<int>(k);
    EXPECT_LT((world.bodies().pose[plank].x - at[k]).norm(), 1e-4) << "plank " << k;
    EXPECT_LT(world.bodies().velocity[plank].v.norm(), 1e-3) << "plank " << k;
  }
}

// A tower of twenty stands about the loads that it began with; fifteen are knocked off.
TEST(SmallSteps, WhatWasUnderALoadDoesNotHoverOnceItIsGone) {
  constexpr int kCount = 20, kLeft = 5;
  World world(asByDefault());
  addGround(world);
  const BodyId first = addStack(world, kCount);
  run(world, 60);
  for (int k = kLeft; k < kCount; ++k) {
    world.setVelocity(first + k, {Vec3(30, 2, 0), Vec3::Zero()});
  }
  run(world, 120);
  double below = 0;
  for (int k = 0; k < kLeft; ++k) {
    const double top = world.bodies().pose[first + k].x.y() + 0.5;
    EXPECT_LT(top - 1 - below, 2e-5) << "box " << k;  // 0.9 mm where it stands about former loads
    EXPECT_GT(top - 1 - below, -5e-4) << "box " << k;
    below = top;
  }
}

// Masses far apart neither open joints nor give energy.
class HeavyEnd : public ::testing::TestWithParam<double> {};
TEST_P(HeavyEnd, KeepsTheChainClosedAndItsEnergyBounded) {
  Settings settings = asByDefault();
  settings.contact.reset();
  World world(settings);
  BodyId last = kWorldBody;
  for (int k = 0; k < 20; ++k) {
    BodyDef def;
    def.shape = Box{Vec3(0.5, 0.08, 0.08)};
    def.mass = k == 19 ? GetParam() : 1;
    def.pose.x = Vec3(0.25 + 0.5 * k, 0, 0);
    const BodyId id = world.add(def);
    BallSocketDef joint;
    joint.bodies = {last, id};
    joint.at = Vec3(0.5 * k, 0, 0);
    world.add(joint);
    last = id;
  }
  const double before = measure(world).total();
  double gap = 0, most = before;
  for (int k = 0; k < 600; ++k) {
    world.step();
    gap = std::max(gap, world.constraintErrors().front().largest);
    most = std::max(most, measure(world).total());
  }
  EXPECT_LT(gap, 1e-5);  // measured 5e-6 m and less
  EXPECT_LE(most, before + 1e-9 * GetParam());
}
INSTANTIATE_TEST_SUITE_P(MassRatios, HeavyEnd, ::testing::Values(1, 100, 250, 300, 1000, 1e4));

// `build` makes a world with or without company, and returns the first of `count` bodies that are
// not to know of it.
template <class F>
void expectSameAlone(int count, F&& build) {
  World alone(asByDefault()), accompanied(asByDefault());
  const BodyId i = build(alone, false), j = build(accompanied, true);
  run(alone, 120);
  run(accompanied, 120);
  for (int k = 0; k < count; ++k) expectSameBytes(alone, i + k, accompanied, j + k);
}

// Its turns are seen, as those of what nothing turns are.
TEST(LaneMass, OfABodyTooHeavyForSinglePrecisionHasAnInverse) {
  JointMass mass;
  mass.inertia = 1e-90 * Mat3::Identity();
  const LaneInverse inverse = inverseOf(laneMassOf(mass));
  for (const double entry : inverse.entries) EXPECT_TRUE(std::isfinite(entry)) << entry;
}

// What happens in one island cannot change a byte in another.
TEST(SmallSteps, IslandsDoNotKnowOfEachOther) {
  const auto build = [](World& world, bool withNeighbour) {
    addGround(world);
    const BodyId first = addStack(world, 6);
    if (withNeighbour) {
      addStack(world, 9, 30);
      addBody(world, Sphere{0.5}, Vec3(60, 0.5, 0), 100);
    }
    return first;
  };
  expectSameAlone(6, build);
}

// Neither where the other has to look for its contacts twice in a step.
TEST(SmallSteps, AFastPairElsewhereDoesNotMoveAByte) {
  const auto build = [](World& world, bool withNeighbour) {
    addGround(world);
    const BodyId first = addStack(world, 4);
    world.setVelocity(first + 3, {Vec3(0.5, 0, 0.3), Vec3(0, 1, 0)});
    if (withNeighbour) {
      const BodyId box = addBody(world, Box{Vec3(1, 1, 1)}, Vec3(40, 3, 0), 1);
      world.setVelocity(box, {Vec3(3, -20, 0), Vec3(1, 2, 3)});
    }
    return first;
  };
  expectSameAlone(4, build);
}

// Neither where the other turns so far in a step that its rows are prepared anew.
TEST(SmallSteps, ASpinningBoxElsewhereDoesNotMoveAByte) {
  const auto build = [](World& world, bool withNeighbour) {
    addGround(world);
    const BodyId first = addStack(world, 4);
    for (BodyId k = 0; k < 4; ++k) {
      world.setVelocity(first + k, {Vec3(0.05, 0, 0.1), Vec3(0.1, 2 - k, 0.2)});
    }
    if (withNeighbour) {
      const BodyId spinning = addStack(world, 4, 30);
      for (BodyId k = 0; k < 4; ++k) {
        world.setVelocity(spinning + k, {Vec3::Zero(), Vec3(0, 10 + 5 * k, 0)});
      }
    }
    return first;
  };
  expectSameAlone(4, build);
}

// Joints are closed as far where something rests elsewhere, with as many substeps and sweeps.
TEST(SmallSteps, AStackElsewhereDoesNotMoveAByteOfAChain) {
  const auto build = [](World& world, bool withStack) {
    addGround(world);
    ChainDef chain;
    chain.from = Vec3(0, 10, 0);
    chain.direction = Vec3::UnitX();
    chain.length = 0.3;
    chain.matter.mass = 1;
    chain.count = 6;
    const BodyId first = add(world, chain).front();
    if (withStack) addStack(world, 1, 40);
    return first;
  };
  expectSameAlone(6, build);
}

// What a hit sets in motion meets what stood beside it in the next step at the latest: it has come
// into it by what is left of its way in this one, and is pushed out.
TEST(SmallSteps, AFastHitIsPassedOnInTheNextStep) {
  Settings settings = asByDefault();
  settings.gravity.reset();
  World world(settings);
  const BodyId first = addBody(world, Sphere{0.5}, Vec3(0, 0, 0), 1);
  addBody(world, Sphere{0.5}, Vec3(1.1, 0, 0), 1);
  const BodyId last = addBody(world, Sphere{0.5}, Vec3(2.2, 0, 0), 1);
  world.setVelocity(first, {Vec3(30, 0, 0), Vec3::Zero()});
  double overlap = 0;
  for (int k = 0; k < 10; ++k) {
    world.step();
    overlap = std::max(overlap, world.largestOverlap());
  }
  EXPECT_GT(world.bodies().velocity[last].v.x(), 5);
  EXPECT_LT(overlap, 15.0 / 60 - 0.1);
  EXPECT_LT(world.largestOverlap(), 1e-3);
}

TEST(SmallSteps, AFreeBodyFliesAlongTheParabola) {
  World world(asByDefault());
  BodyDef def;
  def.shape = Box{Vec3(1, 2, 3)};
  def.velocity.v = Vec3(1, 2, 3);
  const BodyId body = world.add(def);
  run(world, 60);
  const Vec3 expected = Vec3(1, 2, 3) + 0.5 * Vec3(0, -9.81, 0);
  EXPECT_LT((world.bodies().pose[body].x - expected).norm(), 1e-12);
}

// Displacements are single precision, poses are not: a place does not matter.
TEST(SmallSteps, AMillionMetresAwayAStackStandsAsWell) {
  World world(asByDefault());
  addGround(world);
  BodyId first = addStack(world, 5, 1e6);
  run(world, 300);
  for (int k = 0; k < 5; ++k) {
    const Vec3 x = world.bodies().pose[first + k].x;
    EXPECT_NEAR(x.x() - 1e6, 0, 1e-3);
    EXPECT_NEAR(x.y(), k + 0.5, 1e-3);
  }
}

// Two boxes a quarter inside each other come apart level, no faster than they may.
TEST(SmallSteps, OverlapIsTakenBackLevel) {
  Settings settings = asByDefault();
  settings.gravity.reset();
  World world(settings);
  addBody(world, Box{Vec3(1, 1, 1)}, Vec3(0, 0, 0), 1);
  const BodyId upper = addBody(world, Box{Vec3(1, 1, 1)}, Vec3(0, 0.75, 0), 1);
  run(world, 6);
  EXPECT_LE(world.bodies().pose[upper].x.y() - 0.75, 0.5 * 0.1 * 1.02);  // half of 1 m/s
  run(world, 114);
  EXPECT_LT(world.bodies().pose[upper].q.vec().norm(), 1e-3);
  EXPECT_NEAR(world.bodies().pose[upper].x.y(), 0.875, 5e-3);
}

TEST(SmallSteps, AtAHitMomentumIsKept) {
  Settings settings = asByDefault();
  settings.gravity.reset();
  World world(settings);
  const BodyId a = addBody(world, Box{Vec3(1, 1, 1)}, Vec3(0, 0, 0), 2);
  const BodyId b = addBody(world, Box{Vec3(1, 1, 1)}, Vec3(1.5, 0.3, 0.1), 3);
  world.setVelocity(a, {Vec3(10, 0, 0), Vec3::Zero()});
  run(world, 60);
  const auto& v = world.bodies().velocity;
  EXPECT_GT(v[b].v.x(), 1);
  EXPECT_LT((2 * v[a].v + 3 * v[b].v - Vec3(20, 0, 0)).norm(), 1e-5);  // float: 1e-7 of 20
}

// Two blocks of a colour with so many points, whose bodies come to `masses` and `motions`: every
// number another one.
struct TwoBlocks {
  static constexpr int kSlots = 33;
  ContactBlock blocks[2]{};
  LaneMass masses[kSlots]{};
  LaneMotion motions[kSlots]{};

  explicit TwoBlocks(int points) {
    for (int s = 1; s < kSlots; ++s) {
      masses[s].inverse = 1 + next();
      for (const int k : {0, 3, 5}) masses[s].root[k] = 1.5f + next();
      for (const int k : {1, 2, 4}) masses[s].root[k] = 0.2f * next();
      for (int k = 0; k < 3; ++k) {
        motions[s].u[k] = 0.01f * next(), motions[s].turn[k] = 0.01f * next();
      }
    }
    for (int i = 0; i < 2; ++i) fill(blocks[i], points, 1 + 16 * i);
  }

  void work(const ContactKernels& kernels, const ContactSweeps& sweeps) {
    kernels.prepare(blocks, 2, masses, FrictionAt{0.02f});
    sweeps.warmStart(blocks, 2, motions);
    sweeps.sweepPositions(blocks, 2, motions, {});
    sweeps.sweepPositions(blocks, 2, motions, {.onlyDeep = true});
    for (int k = 0; k < 3; ++k) {
      sweeps.sweepVelocities(blocks, 2, motions, {.first = k == 0, .left = 2 - k});
    }
  }
  void expectTheSame(const TwoBlocks& other) const {
    EXPECT_EQ(std::memcmp(blocks, other.blocks, sizeof blocks), 0);
    EXPECT_EQ(std::memcmp(motions, other.motions, sizeof motions), 0);
  }

 private:
  float next() {
    return static_cast<float>((seed_ = seed_ * 1103515245u + 12345u) >> 9) / 8388608.f - 0.5f;
  }
  void fill(ContactBlock& block, int points, int first) {
    block.points = points;
    block.colour = 0;
    for (int l = 0; l < 8; ++l) {
      block.bodyA[l] = first + 2 * l;
      block.bodyB[l] = l == 3 ? 0 : first + 1 + 2 * l;
      const Vec3 n = Vec3{next(), next(), next()}.normalized();
      for (int k = 0; k < 3; ++k) block.n[k][l] = static_cast<float>(n[k]);
      block.scale[l] = 0.9f, block.rate[l] = 0.2f, block.push[l] = 0.01f;
      block.staticFriction[l] = 0.6f, block.dynamicFriction[l] = 0.5f;
      for (auto& p : block.point) {
        for (int k = 0; k < 3; ++k) p.wA[k][l] = next(), p.wB[k][l] = next();
        p.lambda[l] = 0.01f * (0.5f + next()), p.inverse[l] = 1;
      }
      for (auto& gap : block.gap) gap[l] = 0.01f * next();
    }
  }

  unsigned seed_ = 1;
};

// The same bytes from any set of registers.
class ContactKernelsOf : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Points, ContactKernelsOf, ::testing::Values(1, 2, 3, 4));

TEST_P(ContactKernelsOf, GiveTheSameBytesInHalvesAndInOne) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2 here";
  TwoBlocks narrow(GetParam()), wide = narrow;
  narrow.work(kContactKernelsSse2, kContactKernelsSse2);
  wide.work(kContactKernelsAvx2, kContactKernelsAvx2);
  wide.expectTheSame(narrow);
}

TEST_P(ContactKernelsOf, GiveTheSameBytesForTwoBlocksAtATime) {
  if (!__builtin_cpu_supports("avx512f")) GTEST_SKIP() << "no AVX-512 here";
  TwoBlocks each(GetParam()), both = each;
  each.work(kContactKernelsAvx2, kContactKernelsAvx2);
  both.work(kContactKernelsAvx2, kContactSweepsAvx512);
  both.expectTheSame(each);
}

// What one of the two has nothing to do with leaves no trace in it, not in the sign of a zero.
TEST_P(ContactKernelsOf, LeaveAloneWhatOnlyTheOtherOfTwoBlocksHas) {
  if (!__builtin_cpu_supports("avx512f")) GTEST_SKIP() << "no AVX-512 here";
  for (const int idle : {0, 1}) {
    for (const bool isDeep : {false, true}) {
      TwoBlocks each(GetParam());
      ContactBlock& block = each.blocks[idle];
      for (int l = 0; l < 8; ++l) {
        for (auto& p : block.point) p.lambda[l] = 0;
        for (auto& gap : block.gap) gap[l] = 1;
        block.staticFriction[l] = block.dynamicFriction[l] = 0;
        for (auto& t : block.tangent) t.lambda[l] = -0.f;
        for (const int s : {block.bodyA[l], block.bodyB[l]}) {
          for (float* row : {each.motions[s].u, each.motions[s].turn}) std::fill_n(row, 3, -0.f);
        }
        if (isDeep) each.motions[each.blocks[1 - idle].bodyA[l]].deepest = 0.5f;
      }
      TwoBlocks both = each;
      each.work(kContactKernelsAvx2, kContactKernelsAvx2);
      both.work(kContactKernelsAvx2, kContactSweepsAvx512);
      both.expectTheSame(each);
    }
  }
}

TEST_P(ContactKernelsOf, DoNotTakeBlocksOfTwoColoursTogether) {
  if (!__builtin_cpu_supports("avx512f")) GTEST_SKIP() << "no AVX-512 here";
  TwoBlocks each(GetParam());
  std::copy_n(each.blocks[0].bodyA, 8, each.blocks[1].bodyB);  // the first pushes the second's
  each.blocks[1].colour = 1;
  TwoBlocks both = each;
  each.work(kContactKernelsAvx2, kContactKernelsAvx2);
  both.work(kContactKernelsAvx2, kContactSweepsAvx512);
  both.expectTheSame(each);
}

// In reach of a wall and of nothing else: no contact is at work, and energy is kept though it turns
// by half a radian in a substep.
TEST(SmallSteps, ABodyThatSpinsFastBesideAWallKeepsItsEnergy) {
  Settings settings = asByDefault();
  settings.gravity.reset();
  World world(settings);
  addBody(world, Box{Vec3(10, 1, 10)}, Vec3(0, -0.5, 0), 1, Motion::kStatic);
  const BodyId body = addBody(world, Box{Vec3(0.2, 0.3, 0.4)}, Vec3(0, 0.275, 0));
  world.setVelocity(body, {Vec3::Zero(), Vec3(10, 120, 30)});
  const auto spin = [&] {
    const Bodies& b = world.bodies();
    const Vec3 w = b.pose[body].q.conjugate() * b.velocity[body].w;
    return 0.5 * w.dot(b.inertia[body].cwiseProduct(w));
  };
  const double start = spin();
  run(world, 60);
  EXPECT_NEAR(spin() / start, 1, 1e-9);
}

// A heap of boxes that fall on each other turned anyhow: none comes further into another than a
// twentieth of its size, and what has fallen is a heap.
TEST(SmallSteps, BoxesThatFallOnAHeapHardlyOverlap) {
  World world(asByDefault());
  addGround(world);
  std::mt19937 random(1);
  const auto number = [&] { return random() / 4294967296.0 * 2 - 1; };
  for (int k = 0; k < 125; ++k) {
    BodyDef def;
    def.shape = Box{Vec3(1, 1, 1)};
    def.pose.x = 1.75 * Vec3(k % 5 - 2, k / 25 + 0.6, k / 5 % 5 - 2);
    def.pose.q = exponential(2 * Vec3{number(), number(), number()});
    def.friction = Friction{0.6, 0.6};
    world.add(def);
  }
  double overlap = 0;
  for (int k = 0; k < 300; ++k) {
    world.step();
    overlap = std::max(overlap, world.largestOverlap());
  }
  EXPECT_LT(overlap, 0.05);
  EXPECT_LT(world.largestOverlap(), 5e-3);
}

// A wall of 1 cm just behind a ball, which a fast one hits in the middle of a step: what is left of
// the step would take it through the wall, which it was not about to meet.
TEST(SmallSteps, WhatIsHitDoesNotGoThroughTheWallBehindIt) {
  Settings settings = asByDefault();
  settings.gravity.reset();
  for (const double speed : {10.0, 30.0, 100.0, 300.0}) {
    for (const double gap : {0.015, 0.05, 0.2}) {
      World world(settings);
      addBody(world, Box{Vec3(0.01, 4, 4)}, Vec3::Zero(), 1, Motion::kStatic);
      const BodyId hit = addBody(world, Sphere{0.1}, Vec3(-0.105 - gap, 0, 0));
      const BodyId fast = addBody(world, Sphere{0.1}, Vec3(-3, 0, 0));
      world.setVelocity(fast, {Vec3(speed, 0, 0), Vec3::Zero()});
      double furthest = -3;
      for (int k = 0; k < 60; ++k) {
        world.step();
        for (const BodyId i : {hit, fast}) {
          furthest = std::max(furthest, world.bodies().pose[i].x.x());
        }
      }
      EXPECT_LT(furthest, -0.1) << speed << " m/s, " << gap << " m";
    }
  }
}

// A wall of bricks, 0.5 by 0.25 by 0.25 m, and a ball of two tons.
BodyId addWallAndBall(World& world, double speed) {
  addGround(world);
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 8; ++column) {
      const double x = (column - 3.5 + 0.5 * (row % 2)) * 0.5;
      addBody(world, Box{Vec3(0.5, 0.25, 0.25)}, Vec3(x, 0.25 * row + 0.125, 0), 62.5);
    }
  }
  const BodyId ball = addBody(world, Sphere{0.4}, Vec3(0.1, 1.4, 8), 2000);
  world.setVelocity(ball, {Vec3(0, 0, -speed), Vec3::Zero()});
  return ball;
}

// Within a step the ball slides past bricks whose other corners meet it then.
TEST(SmallSteps, AWallThatAFastBallGoesThroughHardlyOverlapsWithItNorGainsEnergy) {
  for (const double speed : {50.0, 100.0, 200.0}) {
    World world(asByDefault()), looked(asByDefault());
    addWallAndBall(world, speed);
    addWallAndBall(looked, speed);
    double overlap = 0, energy = measure(world).total();
    for (int k = 0; k < 60; ++k) {
      world.step();
      ASSERT_TRUE(looked.setState(world.bodies().pose, world.bodies().velocity));
      overlap = std::max(overlap, looked.largestOverlap());
      const double now = measure(world).total();
      EXPECT_LT(now, energy * (1 + 1e-3)) << speed << " m/s, step " << k;
      energy = now;
    }
    EXPECT_LT(overlap, 0.05) << speed << " m/s";
  }
}

// A hand that is led along and turned, with an arm hanging from it.
TEST(SmallSteps, JointsStayClosedAtABodyThatMovesByItself) {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  World world(settings);
  const BodyId hand =
      addBody(world, Box{Vec3(0.1, 0.1, 0.1)}, Vec3(0, 5, 0), 1, Motion::kKinematic);
  const BodyId arm = addBody(world, Box{Vec3(0.1, 0.4, 0.1)}, Vec3(0.1, 4.7, 0));
  BallSocketDef def;
  def.bodies = {hand, arm};
  def.at = Vec3(0.1, 4.95, 0);
  world.add(def);
  world.setVelocity(hand, {Vec3(2, 0, 0.5), Vec3(0, 1, 3)});
  for (int k = 0; k < 60; ++k) {
    world.step();
    ASSERT_LT(world.constraintErrors().at(0).largest, 1e-10) << "step " << k;  // 1.2e-12
  }
}

}  // namespace
}  // namespace physics::testing
