// Impacts: energy, restitution, and bodies too fast for one step.
#include <gtest/gtest.h>

#include "physics/world/measure.h"
#include "tests/physics/pair.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {
namespace {

Settings collisions(double dt, double restitution) {
  Settings settings = sweeps();
  settings.dt = dt;
  settings.substeps = 1;
  settings.iterations = 8;
  settings.contact = ContactSettings{};
  settings.contact->restitution = restitution;
  return settings;
}

BodyDef metreBall(double mass, const Vec3& x, const Vec3& v) {
  BodyDef def;
  def.shape = Sphere{0.5};
  def.mass = mass;
  def.pose.x = x;
  def.velocity.v = v;
  return def;
}

BodyDef tumblingBox(const Vec3& x, const Vec3& v) {
  BodyDef def;
  def.shape = Box{Vec3(1, 0.6, 0.4)};
  def.pose = {x, about({1, 2, 3}, 0.7)};
  def.velocity = {v, Vec3(2, -3, 1)};
  return def;
}

class Impact : public ::testing::TestWithParam<double> {};  // speed [m/s]
INSTANTIATE_TEST_SUITE_P(At, Impact, ::testing::Values(1.0, 10.0, 60.0, 100.0));

TEST_P(Impact, GainsNoEnergyAndKeepsLinearMomentum) {
  for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    World world(collisions(dt, 0));
    world.add(tumblingBox(Vec3::Zero(), Vec3::Zero()));
    world.add(tumblingBox(Vec3(3, 0.2, 0.1), Vec3(-GetParam(), 0, 0)));
    const Measures first = measure(world);
    double last =
        first.kinetic;  // never above the start; a grazing hit may give back 1 % of its own loss
    while (world.stepCount() * dt < 3 / GetParam() + 1) {
      ASSERT_FALSE(world.step().notFinite);
      const Measures now = measure(world);
      EXPECT_LE(now.kinetic, first.kinetic * (1 + 1e-3));
      last = now.kinetic;
    }
    EXPECT_LT((measure(world).linearMomentum - first.linearMomentum).norm(), 1e-10 * GetParam());
    EXPECT_LT(last, 0.99 * first.kinetic);  // they did meet
  }
}

TEST_P(Impact, OfABallDoesNotTunnelThroughAThinWall) {
  for (const double dt : {1.0 / 30, 1.0 / 60}) {
    World world(collisions(dt, 0));
    BodyDef wall;
    wall.shape = Box{Vec3(0.05, 4, 4)};
    wall.motion = Motion::kStatic;
    world.add(wall);
    world.add(metreBall(1, Vec3(-7.3, 0.1, 0.2), Vec3(GetParam(), 0, 0)));
    while (world.stepCount() * dt < 10 / GetParam()) world.step();
    EXPECT_LT(world.bodies().pose[2].x.x(), -0.5);
  }
}

// C07: v1' = (m1 - e m2) v/(m1 + m2), v2' = (1 + e) m1 v/(m1 + m2).
TEST(Restitution, OfTwoBallsIsTheClosedForm) {
  for (const double e : {0.0, 0.5, 1.0}) {
    World world(collisions(1.0 / 60, e));
    world.add(metreBall(2, Vec3(-2, 0, 0), Vec3(3, 0, 0)));
    world.add(metreBall(1, Vec3::Zero(), Vec3::Zero()));
    for (int k = 0; k < 120; ++k) world.step();
    EXPECT_NEAR(world.bodies().velocity[1].v.x(), (2 - e) * 3 / 3, 1e-9);
    EXPECT_NEAR(world.bodies().velocity[2].v.x(), (1 + e) * 2 * 3 / 3, 1e-9);
  }
}

TEST(Restitution, OfZeroEndsTheApproach) {
  World world(collisions(1.0 / 60, 0));
  world.add(metreBall(2, Vec3(-2, 0, 0), Vec3(3, 0, 0)));
  world.add(metreBall(1, Vec3::Zero(), Vec3::Zero()));
  for (int k = 0; k < 120; ++k) world.step();
  EXPECT_NEAR(world.bodies().velocity[1].v.x(), 2, 1e-12);
  EXPECT_NEAR(world.bodies().velocity[2].v.x(), 2, 1e-12);
  EXPECT_LT(world.largestOverlap(), 1e-12);
}

// An overlap that stood at the start is undone no faster than v_max and gives no speed.
TEST(Overlap, IsUndoneAtTheSeparationSpeedAndLeavesNone) {
  Settings settings = collisions(1.0 / 60, 0);
  settings.method = Method::kSmallSteps;
  settings.contact->maxSeparationSpeed = 0.6;  // .01 m a step
  World world(settings);
  world.add(metreBall(1, Vec3(-0.45, 0, 0), Vec3::Zero()));
  world.add(metreBall(1, Vec3(0.45, 0, 0), Vec3::Zero()));
  world.step();
  const auto& bodies = world.bodies();
  EXPECT_NEAR(bodies.pose[2].x.x() - bodies.pose[1].x.x(), 0.91,
              1e-9);  // from .9, single precision of .01 m
  for (int k = 0; k < 30; ++k) world.step();
  const double left = 1 - (bodies.pose[2].x.x() - bodies.pose[1].x.x());
  EXPECT_GE(left, -1e-12);
  EXPECT_LE(left, 1e-4);
  EXPECT_LT(measure(world).kinetic, 1e-20);
}

// Twenty-seven balls in a box that holds them only overlapped.
struct OverfullBox {
  static constexpr double kHalf = 0.25, kRadius = 0.1;
  World world;
  std::vector<BodyId> balls;

  explicit OverfullBox(const Settings& settings) : world(settings) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        BodyDef wall;
        wall.shape = Plane{side * Vec3::Unit(axis), -kHalf};
        wall.motion = Motion::kStatic;
        world.add(wall);
      }
    }
    for (int i = 0; i < 27; ++i) {
      BodyDef ball;
      ball.shape = Sphere{kRadius};
      ball.mass = 1;
      ball.friction = {0.3, 0.3};
      ball.pose.x =
          0.15 * Vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1) + 1e-3 * Vec3(i % 5, i % 7, i % 4);
      balls.push_back(world.add(ball));
    }
  }

  // What contacts push with in all [N].
  double pressure() const {
    const double h = world.settings().dt / world.settings().substepCount();
    double sum = 0;
    for (const ContactReport& contact : world.contacts()) sum += contact.impulse.norm() / h;
    return sum;
  }
};

// None is pushed through a wall for the others, none through another.
TEST(Overlap, ThatCannotVanishIsShared) {
  Settings settings;
  settings.contact = ContactSettings{};
  settings.iterations = 4;
  OverfullBox box(settings);
  for (int k = 0; k < 240; ++k) box.world.step();
  const auto& pose = box.world.bodies().pose;
  for (const BodyId a : box.balls) {
    EXPECT_LT(pose[a].x.cwiseAbs().maxCoeff(), box.kHalf - 0.6 * box.kRadius);
    EXPECT_LT(box.world.bodies().velocity[a].v.norm(), settings.contact->maxSeparationSpeed);
    for (const BodyId b : box.balls) {
      EXPECT_TRUE(a == b || (pose[a].x - pose[b].x).norm() > 1.2 * box.kRadius);
    }
  }
}

// What presses from all sides balances itself: errors of the sweeps must not heap up in it. They
// came to ten thousand times the weight.
TEST(Overlap, ThatCannotVanishPressesNoHarderWithTime) {
  Settings settings;
  settings.contact = ContactSettings{};
  settings.gravity = Vec3(0, -9.81, 0);
  settings.iterations = 4;
  OverfullBox box(settings);
  const double weight = 9.81 * static_cast<double>(box.balls.size());
  for (int k = 0; k < 600; ++k) {
    box.world.step();
    ASSERT_LT(box.pressure(), 1000 * weight) << k;
  }
}

}  // namespace
}  // namespace physics::testing
