// Second-order steppings beside contacts and limits, and what they keep.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/world/measure.h"
#include "tests/physics/order_cases.h"
#include "tests/physics/stage.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {
namespace {

constexpr Stepping kBoth[] = {Stepping::kBdf2, Stepping::kSymmetric};

class SecondOrderStepping : public ::testing::TestWithParam<Stepping> {};
INSTANTIATE_TEST_SUITE_P(Of, SecondOrderStepping, ::testing::ValuesIn(kBoth), [](const auto& info) {
  return info.param == Stepping::kBdf2 ? "Bdf2" : "Symmetric";
});

Settings withContact(Stepping stepping, double h, double friction, double restitution = 0) {
  Settings s = sweeps(64);
  s.dt = h;
  s.substeps = 1;
  s.stepping = stepping;
  s.gravity = Vec3(0, -10, 0);
  s.contact = ContactSettings{};
  s.contact->friction = {friction, friction};
  s.contact->restitution = restitution;
  return s;
}

BodyId addCube(World& world, const Vec3& x, const Vec3& v = Vec3::Zero()) {
  BodyDef box;
  box.shape = Box{Vec3(1, 1, 1)};
  box.pose.x = x;
  box.velocity.v = v;
  return world.add(box);
}

TEST_P(SecondOrderStepping, FallsByTheParabolaItself) {
  Settings s = smoothSettings(GetParam(), Method::kNonlinearGaussSeidel, 0.1, 1);
  World world(s);
  BodyDef ball;
  ball.velocity.v = Vec3(1, 2, 0);
  world.add(ball);
  for (int k = 0; k < 20; ++k) world.step();
  EXPECT_LT((world.bodies().pose[1].x - Vec3(2, 4 - 0.5 * 9.81 * 4, 0)).norm(), 1e-13);
}

// v0^2/(2 mu g) by Coulomb; the paper's steps are short of it by h v0/2.
TEST_P(SecondOrderStepping, SlidesToAStopAtTheExactDistance) {
  World world(withContact(GetParam(), 0.01, 0.5));
  addGround(world);
  const BodyId box = addCube(world, Vec3(0, 0.5, 0), Vec3(3, 0, 0));
  for (int k = 0; k < 100; ++k) world.step();
  EXPECT_NEAR(world.bodies().pose[box].x.x(), 0.9, 5e-4);  // the paper's: 0.885
  EXPECT_LT(world.bodies().velocity[box].v.norm(), 2e-5);
}

TEST_P(SecondOrderStepping, RestsAtRest) {
  Settings settings = withContact(GetParam(), 1.0 / 60, 0.5);
  settings.iterations = 2000;  // a tower of five is solved
  World world(settings);
  addGround(world);
  for (int k = 0; k < 5; ++k) addCube(world, Vec3(0, 0.5 + k, 0));
  int restarts = 0;
  for (int k = 0; k < 300; ++k) {
    const StepReport report = world.step();
    if (k > 60) restarts += report.restarts;
  }
  EXPECT_LT((world.bodies().pose[6].x - Vec3(0, 4.5, 0)).norm(), 1e-4);
  EXPECT_LT(measure(world).kinetic, 1e-7);
  EXPECT_EQ(restarts, 0);  // a contact that stays is no reason to forget
}

TEST_P(SecondOrderStepping, RestartsWhereVelocitiesJumpAndCountsIt) {
  World world(withContact(GetParam(), 0.01, 0.5));
  addGround(world);
  addCube(world, Vec3(0, 1.5, 0));
  world.step();
  int inFlight = 0, all = 0;
  for (int k = 1; k < 100; ++k) {
    const int restarts = world.step().restarts;
    if (world.bodies().pose[2].x.y() > 0.7) inFlight += restarts;
    all += restarts;
  }
  EXPECT_EQ(inFlight, 0);
  EXPECT_GT(all, 0);
  EXPECT_LT(all, 10);
  EXPECT_NEAR(world.bodies().pose[2].x.y(), 0.5, 1e-4);  // no rebound out of the past's velocity
}

// Two boxes that meet and part: what one loses the other has.
TEST_P(SecondOrderStepping, KeepsMomentumThroughACollision) {
  for (const double restitution : {0.0, 0.5}) {
    Settings s = withContact(GetParam(), 0.01, 0.3, restitution);
    s.gravity.reset();
    World world(s);
    addCube(world, Vec3(0, 0, 0), Vec3(4, 0, 0));
    addCube(world, Vec3(1.5, 0.4, 0.1), Vec3(-1, 0, 0));
    addCube(world, Vec3(3, 0, 0));
    const Measures before = measure(world);
    for (int k = 0; k < 100; ++k) {
      world.step();
      EXPECT_LT((measure(world).linearMomentum - before.linearMomentum).norm(), 1e-12);
    }
    EXPECT_LT(measure(world).kinetic, before.kinetic * (1 + 1e-9));
  }
}

// Joined bodies in free space.
TEST_P(SecondOrderStepping, KeepsBothMomentaOfAHingedPair) {
  for (const Method method : {Method::kNonlinearGaussSeidel, Method::kDirect}) {
    Settings s = smoothSettings(GetParam(), method, 0.01, 1);
    s.gravity.reset();
    World world = orderCases()[4].make(s);
    ASSERT_EQ(orderCases()[4].name, "Hinge");
    const Measures before = measure(world);
    for (int k = 0; k < 200; ++k) world.step();
    const Measures after = measure(world);
    EXPECT_LT((after.linearMomentum - before.linearMomentum).norm(), 1e-11);
    EXPECT_LT((after.angularMomentum - before.angularMomentum).norm(),
              1e-3 * before.angularMomentum.norm());  // of the second order: measured below 1e-4
  }
}

TEST_P(SecondOrderStepping, SetVelocityIsAJumpToo) {
  World world(smoothSettings(GetParam(), Method::kNonlinearGaussSeidel, 0.01, 1));
  BodyDef ball;
  world.add(ball);
  for (int k = 0; k < 5; ++k) world.step();
  world.setVelocity(1, {Vec3(7, 0, 0), Vec3::Zero()});
  const double from = world.bodies().pose[1].x.x();
  for (int k = 0; k < 10; ++k) world.step();
  EXPECT_NEAR(world.bodies().pose[1].x.x() - from, 0.7, 1e-12);
}

}  // namespace
}  // namespace physics::testing
