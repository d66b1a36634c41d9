// The rival methods in contact: rest, friction, stacks, impacts.
#include <cmath>

#include "physics/world/measure.h"
#include "tests/physics/rivals.h"

namespace physics::testing {
namespace {

using RivalContact = Rivals;
INSTANTIATE_TEST_SUITE_P(All, RivalContact, ::testing::ValuesIn(kRivals), nameOf);

// A plane y = 0 with gravity that leans by `slope` towards +x.
World planeWith(Settings s, double slope, double friction) {
  s.gravity = 9.81 * Vec3(std::sin(slope), -std::cos(slope), 0);
  s.contact = ContactSettings{};
  s.contact->friction = {friction, friction};
  World world(s);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  return world;
}

BodyId addBox(World& world, const Vec3& size, double bottom) {
  BodyDef box;
  box.shape = Box{size};
  box.pose.x = Vec3(0, bottom + size.y() / 2, 0);
  return world.add(box);
}

void stepOn(World& world, int steps) {
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(world.step().notFinite) << "step " << k;
}

// What each method gives way by where it should not at 480 steps per second, measured and rounded
// up: one block [m], a stack of five [m], and the speed at which what rests creeps [m/s]. A penalty
// force holds by giving way, and the soft contacts of sequential impulses do so a little. XPBD
// takes slip back only where a point's own normal force allows it and forgets it with the substep:
// resting bodies creep. So do implicit penalty forces, by the points of a manifold that carry
// least.
struct Slack {
  double sink, stack, creep;
};
Slack slackOf(Method method) {
  switch (method) {
    case Method::kXpbd:
      return {1e-4, 3e-2, 2e-2};
    case Method::kSequentialImpulses:
      return {2e-4, 1e-2, 1e-4};
    case Method::kPenalty:
      return {1e-4, 1e-3, 2e-3};
    default:
      return {5e-3, 5e-2, 1e-3};
  }
}

TEST_P(RivalContact, ABlockRests) {
  World world = planeWith(settings(60, 8), 0, 0.5);
  const BodyId box = addBox(world, Vec3(1, 0.5, 1), 0);
  stepOn(world, 120);
  const Vec3 moved = world.bodies().pose[box].x - Vec3(0, 0.25, 0);
  EXPECT_LT(std::abs(moved.y()), slackOf(GetParam().method).sink);
  EXPECT_LT(moved.norm() - std::abs(moved.y()), 2 * slackOf(GetParam().method).creep);
  EXPECT_EQ(world.contactCount(), 4);
}

TEST_P(RivalContact, ABlockHoldsAtNineTenthsOfTheFrictionItNeeds) {
  const double slope = 0.35;
  World world = planeWith(settings(60, 8), slope, std::tan(slope) / 0.9);
  const BodyId box = addBox(world, Vec3(0.6, 0.3, 0.4), 0);
  stepOn(world, 30);
  const double settled = world.bodies().pose[box].x.x();
  stepOn(world, 120);
  EXPECT_NEAR(world.bodies().pose[box].x.x(), settled, 2 * slackOf(GetParam().method).creep);
}

TEST_P(RivalContact, ABlockSlidesAtElevenTenths) {
  const double slope = 0.35, friction = std::tan(slope) / 1.1;
  World world = planeWith(settings(60, 8), slope, friction);
  const BodyId box = addBox(world, Vec3(0.6, 0.3, 0.4), 0);
  stepOn(world, 120);
  const double exact = 0.5 * 9.81 * (std::sin(slope) - friction * std::cos(slope)) * 4;
  const double rubbed = 0.5 * 9.81 * friction * std::cos(slope) * 4;        // by friction alone
  const double missing = GetParam().method == Method::kXpbd ? 0.06 : 0.02;  // of the friction
  EXPECT_NEAR(world.bodies().pose[box].x.x(), exact, missing * rubbed);
}

TEST_P(RivalContact, AStackOfFiveStands) {
  World world = planeWith(settings(60, 8), 0, 0.6);
  BodyId top = 0;
  for (int k = 0; k < 5; ++k) top = addBox(world, Vec3(1, 1, 1), k);
  stepOn(world, 300);
  const Slack slack = slackOf(GetParam().method);
  EXPECT_NEAR(world.bodies().pose[top].x.y(), 4.5, slack.stack);
  EXPECT_LT(world.bodies().pose[top].x.head<1>().norm(), 5 * 5 * slack.creep);
}

World collision(Settings s, double restitution) {
  s.contact = ContactSettings{};
  s.contact->friction = {0, 0};
  s.contact->restitution = restitution;
  World world(s);
  BodyDef ball;
  ball.shape = Sphere{0.5};
  ball.pose.x = Vec3(-1, 0.2, 0);
  ball.velocity.v = Vec3(4, 0, 0);
  world.add(ball);
  ball.mass = 3;
  ball.pose.x = Vec3(1, -0.1, 0);
  ball.velocity.v = Vec3(-1, 0.5, 0);
  world.add(ball);
  return world;
}

TEST_P(RivalContact, ACollisionKeepsTheMomentum) {
  World world = collision(settings(60, 4), 0);
  const Measures before = measure(world);
  stepOn(world, 60);
  const Measures after = measure(world);
  EXPECT_LT((after.linearMomentum - before.linearMomentum).norm(), 1e-11);
  EXPECT_LT(after.kinetic, 0.9 * before.kinetic);  // it did happen
}

TEST_P(RivalContact, ABallBouncesToTheHeightOfItsRestitution) {
  Settings s = settings(60, 16);
  World world = [&] {
    s.gravity = Vec3(0, -kGravity, 0);
    s.contact = ContactSettings{};
    s.contact->restitution = 0.8;
    return World(s);
  }();
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  BodyDef ball;
  ball.shape = Sphere{0.2};
  ball.pose.x = Vec3(0, 1.2, 0);
  const BodyId id = world.add(ball);
  double highest = 0;
  bool hasFallen = false;
  for (int k = 0; k < 54; ++k) {
    world.step();
    hasFallen = hasFallen || world.bodies().velocity[id].v.y() > 0;
    if (hasFallen) highest = std::max(highest, world.bodies().pose[id].x.y() - 0.2);
  }
  EXPECT_NEAR(highest, 0.64, 0.05);
}

// kappa is the scene's to choose: a tenth of the stiffness gives way by ten times as much.
TEST(Penalty, SinksInInverseProportionToItsStiffness) {
  const auto overlap = [](double kappa) {
    Settings s;
    s.method = Method::kPenalty;
    s.substeps = 8;
    s.penaltyStiffness = kappa;
    World world = planeWith(s, 0, 0.5);
    addBox(world, Vec3(1, 0.5, 1), 0);
    for (int k = 0; k < 240; ++k) world.step();
    return world.largestOverlap();
  };
  EXPECT_NEAR(overlap(100) / overlap(1000), 10, 0.1);
}

TEST_P(RivalContact, TheSameSceneGivesTheSameBytes) {
  const auto hash = [&] {
    World world = planeWith(settings(60, 4), 0.1, 0.4);
    for (int k = 0; k < 5; ++k) addBox(world, Vec3(1, 1, 1), 1.01 * k);
    for (int k = 0; k < 60; ++k) world.step();
    return stateHash(world);
  };
  EXPECT_EQ(hash(), hash());
}

}  // namespace
}  // namespace physics::testing
