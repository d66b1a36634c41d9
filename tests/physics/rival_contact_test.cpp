// The rival methods in contact: rest, friction, stacks, impacts.
#include <cmath>

#include "physics/measure.h"
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

void run(World& world, int steps) {
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(world.step().notFinite) << "step " << k;
}

// A penalty force holds what it holds by giving way.
double sink(Method method) { return method == Method::kPenaltyExplicit ? 5e-3 : 1e-4; }

TEST_P(RivalContact, ABlockRests) {
  World world = planeWith(settings(60, 8), 0, 0.5);
  const BodyId box = addBox(world, Vec3(1, 0.5, 1), 0);
  run(world, 120);
  EXPECT_LT((world.bodies().pose[box].x - Vec3(0, 0.25, 0)).norm(), sink(GetParam().method));
  EXPECT_LT(world.bodies().velocity[box].v.norm(), 2e-3);
  EXPECT_EQ(world.contactCount(), 4);
}

TEST_P(RivalContact, ABlockHoldsAtNineTenthsOfTheFrictionItNeeds) {
  const double slope = 0.35;
  World world = planeWith(settings(60, 8), slope, std::tan(slope) / 0.9);
  const BodyId box = addBox(world, Vec3(0.6, 0.3, 0.4), 0);
  run(world, 30);
  const double settled = world.bodies().pose[box].x.x();
  run(world, 120);
  EXPECT_NEAR(world.bodies().pose[box].x.x(), settled, 2e-3);
}

TEST_P(RivalContact, ABlockSlidesAtElevenTenths) {
  const double slope = 0.35, friction = std::tan(slope) / 1.1;
  World world = planeWith(settings(60, 8), slope, friction);
  const BodyId box = addBox(world, Vec3(0.6, 0.3, 0.4), 0);
  run(world, 120);
  const double exact = 0.5 * 9.81 * (std::sin(slope) - friction * std::cos(slope)) * 4;
  EXPECT_NEAR(world.bodies().pose[box].x.x(), exact, 0.15 * exact);
}

TEST_P(RivalContact, AStackOfFiveStands) {
  World world = planeWith(settings(60, 8), 0, 0.6);
  BodyId top = 0;
  for (int k = 0; k < 5; ++k) top = addBox(world, Vec3(1, 1, 1), k);
  run(world, 300);
  const double drop = GetParam().method == Method::kPenaltyExplicit ? 0.05 : 0.01;
  EXPECT_LT((world.bodies().pose[top].x - Vec3(0, 4.5, 0)).norm(), drop);
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
  run(world, 60);
  const Measures after = measure(world);
  EXPECT_LT((after.linearMomentum - before.linearMomentum).norm(), 1e-12);
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
