// Misprints of the paper's contacts, friction and springs, sections 7 and 8.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/constraints/ball_socket.h"
#include "physics/constraints/distance.h"
#include "physics/constraints/spring.h"
#include "physics/world.h"
#include "tests/physics/pair.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {
namespace {

// A floor at y = 0 as a rope from high above, a particle on it, and a rod to a second one.
struct Heights {
  double low = -0.1, high = 1.2, floorImpulse = 0;
};

Heights printed95Clamp() {
  Heights now;
  for (int k = 0; k < 50; ++k) {
    const double change = std::max(-now.low, 0.0);  // the increment clamped
    now.floorImpulse += change;
    now.low += change;
    const double c = now.high - now.low - 1;
    now.low += c / 2;
    now.high -= c / 2;
  }
  return now;
}

Heights ours95Clamp() {
  Bodies bodies = bodiesOf({{0, Vec3::Zero(), {}},
                            {1, Vec3::Zero(), at(Vec3(0, -0.1, 0))},
                            {1, Vec3::Zero(), at(Vec3(0, 1.2, 0))}});
  const Distance floor{{0, 1}, {Vec3(0, 10, 0), Vec3::Zero()}, 10, true};
  const Distance rod{{1, 2}, {Vec3::Zero(), Vec3::Zero()}, 1};
  Multipliers<Distance> onFloor, onRod;
  for (int k = 0; k < 50; ++k) {
    visit(floor, onFloor, bodies);
    visit(rod, onRod, bodies);
  }
  return {bodies.pose[1].x.y(), bodies.pose[2].x.y(), onFloor.total[0]};
}

TEST(Erratum95, ClampedIncrementsCannotTakeAnImpulseBack) {
  EXPECT_NEAR(printed95Clamp().low, 0.1, 1e-9);
  EXPECT_NEAR(printed95Clamp().high, 1.1, 1e-9);
  EXPECT_NEAR(printed95Clamp().floorImpulse, 0.1, 1e-9);
  EXPECT_NEAR(ours95Clamp().low, 0.05, 1e-9);
  EXPECT_NEAR(ours95Clamp().high, 1.05, 1e-9);
  EXPECT_EQ(ours95Clamp().floorImpulse, 0);
}

// One step of 1/60 s above the plane y = 0; no gravity, no friction unless asked.
World floorWorld(const Vec3& gravity, double friction) {
  Settings settings = sweeps(64);
  settings.substeps = 1;
  settings.gravity = gravity;
  settings.contact = ContactSettings{};
  settings.contact->friction = {friction, friction};
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  return world;
}

BodyDef boxOnFloor(const Vec3& v) {
  BodyDef def;
  def.shape = Box{Vec3(0.6, 0.2, 0.6)};
  def.pose.x = Vec3(0, 0.1, 0);
  def.velocity.v = v;
  return def;
}

// Gap after one step of a ball that started `gap` above the floor.
double gapAfterStep(double gap, double speed) {
  World world = floorWorld(Vec3::Zero(), 0);
  BodyDef ball;
  ball.shape = Sphere{0.5};
  ball.pose.x = Vec3(0, 0.5 + gap, 0);
  ball.velocity.v = Vec3(0, speed, 0);
  const BodyId id = world.add(ball);
  world.step();
  return world.bodies().pose[id].x.y() - 0.5;
}

TEST(Erratum95, AsPrintedTheMinimumNeverPushesAndGlues) {
  const auto printed = [](double gap) { return gap + std::min(-gap, 0.0); };
  EXPECT_EQ(printed(-0.1), -0.1);
  EXPECT_EQ(printed(0.1), 0);
  EXPECT_NEAR(gapAfterStep(0.1, -12), 0, 1e-12);  // would be -.1
  EXPECT_NEAR(gapAfterStep(0.1, 0), 0.1, 1e-15);
}

// A beam falls on a support half a metre from its middle.
TEST(Erratum95, TheBodiesTurnToo) {
  World world = floorWorld(Vec3::Zero(), 0);
  BodyDef support, beam;
  support.shape = Sphere{0.5};
  support.pose.x = Vec3(0.5, 2, 0);
  support.motion = Motion::kStatic;
  world.add(support);
  beam.shape = Box{Vec3(2, 0.2, 0.2)};
  beam.pose.x = Vec3(0, 2.605, 0);
  beam.velocity.v = Vec3(0, -1, 0);
  const BodyId id = world.add(beam);
  world.step();
  const Velocity& after = world.bodies().velocity[id];
  const double impulse = after.v.y() + 1, inertia = (4 + 0.04) / 12;
  EXPECT_GT(impulse, 0.3);
  EXPECT_NEAR(after.w.z(), 0.5 * impulse / inertia,
              0.02 * after.w.z());  // the lever turns a little
}

// d(p_i - p_j).s for a turn of body j; (97) prints r_i where r_j stands.
TEST(Erratum97, TheLastEntryIsThatOfTheSecondBodysLever) {
  Random random(31);
  const Bodies bodies = randomPair(random);
  const BallSocket points{{0, 1}, {Vec3(0.4, 0.1, -0.2), Vec3(-0.3, 0.5, 0.1)}};
  const Vec3 s = Vec3(1, 2, -2) / 3;
  const auto row = rowOf(points, bodies);
  const Vec3 ri = bodies.pose[0].q * points.anchors[0];
  for (int k = 0; k < 3; ++k) {
    Bodies ahead = bodies, behind = bodies;
    displace(ahead.pose[1], Vec3::Zero(), 1e-5 * Vec3::Unit(k));
    displace(behind.pose[1], Vec3::Zero(), -1e-5 * Vec3::Unit(k));
    const double difference = (rowOf(points, ahead).c - rowOf(points, behind).c).dot(s) / 2e-5;
    EXPECT_NEAR(s.dot(row.angular[1].col(k)), difference, 1e-9);
    EXPECT_GT(std::abs(-ri.cross(s)[k] - difference), 0.01);
  }
}

TEST(Erratum100, ThePrintedProjectorHasNothingAlongTheSlip) {
  Random random(32);
  for (int n = 0; n < 100; ++n) {
    const Vec3 normal = random.inBall(1).normalized(), dp = random.inBall(1);
    const Vec3 tangential = dp - dp.dot(normal) * normal, s = tangential.normalized();
    EXPECT_NEAR(s.dot(dp - s * s.dot(dp)), 0, 1e-14);
    EXPECT_LT((s * s.dot(dp) - tangential).norm(), 1e-14);
  }
}

TEST(Erratum100, OursStopsASlowSlipInOneStep) {
  World world = floorWorld(Vec3(0, -9.81, 0), 0.5);
  const BodyId id = world.add(boxOnFloor(Vec3(0.01, 0, -0.02)));
  world.step();
  EXPECT_LT(world.bodies().velocity[id].v.norm(), 1e-4);  // of .022, after 8 sweeps
}

// On a slope of 20 degrees with nu = .6 and g = 10, for 1 s. The printed friction measures between
// points made anew at X^{t+1}: they coincide there, so that nothing holds the body.
TEST(Erratum96, FrictionIsMeasuredFromTheMatterAtTheStartOfTheStep) {
  const Vec3 g = 10 * Vec3(std::sin(20 * kDegree), -std::cos(20 * kDegree), 0);
  const double h = 1.0 / 60;
  double printed = 0, speed = 0;
  World world = floorWorld(g, 0.6);
  const BodyId id = world.add(boxOnFloor(Vec3::Zero()));
  for (int k = 0; k < 60; ++k) {
    speed += h * g.x();
    printed += h * speed;
    world.step();
  }
  EXPECT_NEAR(printed, 1.74, 0.005);
  EXPECT_LT(std::abs(world.bodies().pose[id].x.x()), 1e-6);
}

// A stretched spring between points at 0 and 2, rest length 1.
TEST(Erratum109, AsPrintedAStretchedSpringRepels) {
  const double dp = 2;            // printed: p_j - p_i
  EXPECT_LT(-100 * (dp - 1), 0);  // f on body i: away from j
  Bodies bodies = bodiesOf({{1, Vec3::Zero(), {}}, {1, Vec3::Zero(), at(Vec3(2, 0, 0))}});
  iterate(Spring{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 100, 0, 1}, bodies, 1);
  EXPECT_GT(bodies.pose[0].x.x(), 0);
  EXPECT_LT(bodies.pose[1].x.x(), 2);
}

}  // namespace
}  // namespace physics::testing
