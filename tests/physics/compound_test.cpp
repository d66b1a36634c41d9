// Bodies of several shapes in a world: by the default and by the paper's method.
#include "physics/bodies/compound.h"

#include <gtest/gtest.h>

#include <set>

#include "physics/make/weld.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

Settings onDefaults() {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  return settings;
}

// A box of 1 x 0.5 x 0.6 m in two halves that lie on each other.
Compound halves() {
  const Box half{Vec3(1, 0.25, 0.6)};
  const std::vector<PartDef> parts = {{half, {Vec3(0, -0.125, 0), Quat::Identity()}, 1},
                                      {half, {Vec3(0, 0.125, 0), Quat::Identity()}, 1}};
  return makeCompound(parts).compound;
}

BodyDef thrown(const Shape& shape) {
  BodyDef def;
  def.shape = shape;
  def.mass = 2;
  def.pose.x = Vec3(0, 3, 0);
  def.velocity = {Vec3(1, 2, 0), Vec3(3, 0.2, 1)};
  return def;
}

TEST(Compound, FliesAsTheOneShapeThatItIsMadeOf) {
  World whole(onDefaults()), several(onDefaults());
  const BodyId a = whole.add(thrown(Box{Vec3(1, 0.5, 0.6)})), b = several.add(thrown(halves()));
  run(whole, 60);
  run(several, 60);
  EXPECT_NEAR((whole.bodies().pose[a].x - several.bodies().pose[b].x).norm(), 0, 1e-12);
  EXPECT_NEAR(whole.bodies().pose[a].q.angularDistance(several.bodies().pose[b].q), 0, 1e-10);
}

// The upper half never touches the ground: contacts are those of the box.
TEST(Compound, LandsAndSlidesAsTheOneShapeThatItIsMadeOf) {
  const auto slide = [](const Shape& shape, const Settings& settings) {
    World world(settings);
    addGround(world);
    BodyDef def = thrown(shape);
    def.pose.x = Vec3(0, 0.25, 0);
    def.velocity = {Vec3(3, 0, 0), Vec3::Zero()};
    const BodyId id = world.add(def);
    run(world, 90);
    return world.bodies().pose[id].x;
  };
  for (const Settings& settings : {onDefaults(), grounded()}) {
    const Vec3 whole = slide(Box{Vec3(1, 0.5, 0.6)}, settings), several = slide(halves(), settings);
    EXPECT_GT(whole.x(), 0.5);
    EXPECT_NEAR((whole - several).norm(), 0, 1e-6);
  }
}

// A table of a top and four legs: at rest on its feet, each part in contact by itself.
PrincipalCompound table() {
  std::vector<PartDef> parts = {
      {Box{Vec3(1.2, 0.1, 0.8)}, {Vec3(0, 0.75, 0), Quat::Identity()}, 8}};
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.3, 0.3}) {
      parts.push_back({Box{Vec3(0.1, 0.7, 0.1)}, {Vec3(x, 0.35, z), Quat::Identity()}, 1});
    }
  }
  return makeCompound(parts);
}

TEST(Compound, StandsOnFourLegs) {
  for (const Settings& settings : {onDefaults(), grounded()}) {
    World world(settings);
    addGround(world);
    const PrincipalCompound made = table();
    BodyDef def;
    def.shape = made.compound;
    def.mass = made.mass;
    def.pose = made.toParts;
    const BodyId id = world.add(def);
    run(world, 120);
    EXPECT_NEAR((world.bodies().pose[id].x - made.toParts.x).norm(), 0, 2e-3);
    EXPECT_LT(world.bodies().velocity[id].v.norm(), 1e-3);
    double weight = 0;
    std::set<double> sides;
    for (const ContactReport& contact : world.contacts()) {
      weight += contact.impulse.y() * world.substepsOf(id) / settings.dt;
      sides.insert(contact.point.x() > 0 ? 1 : -1);
    }
    EXPECT_NEAR(weight, 12 * 9.81, 0.5);
    EXPECT_EQ(sides.size(), 2u);
  }
}

TEST(Compound, SleepsAndWakesWhole) {
  Settings settings = onDefaults();
  settings.sleep = SleepSettings{};
  World world(settings);
  addGround(world);
  const PrincipalCompound made = table();
  BodyDef def;
  def.shape = made.compound;
  def.mass = made.mass;
  def.pose = made.toParts;
  const BodyId id = world.add(def);
  run(world, 150);
  EXPECT_TRUE(world.isAsleep(id));
  const int resting = world.contactCount();
  EXPECT_GE(resting, 4);
  world.setVelocity(id, {Vec3(0, 3, 0), Vec3::Zero()});
  run(world, 5);
  EXPECT_FALSE(world.isAsleep(id));
  EXPECT_GT(world.bodies().pose[id].x.y(), made.toParts.x.y() + 0.1);
}

TEST(Compound, GivesTheSameBytesForAnyNumberOfThreads) {
  std::vector<Pose> first;
  for (const int threads : {1, 3}) {
    World world(onDefaults());
    world.setThreads(threads);
    addGround(world);
    for (int i = 0; i < 40; ++i) {
      BodyDef def = thrown(halves());
      def.pose.x = Vec3(0.3 * (i % 4), 0.5 + 0.4 * i, 0.2 * (i % 3));
      world.add(def);
    }
    run(world, 60);
    if (first.empty()) first = world.bodies().pose;
    for (BodyId i = 0; i < world.bodyCount(); ++i) {
      EXPECT_EQ(first[i].x, world.bodies().pose[i].x);
      EXPECT_EQ(first[i].q.coeffs(), world.bodies().pose[i].q.coeffs());
    }
  }
}

// Two bars welded at a right angle keep their pose against each other when one end is struck.
TEST(Weld, KeepsTwoBodiesAsOne) {
  Settings settings = onDefaults();
  World world(settings);
  addGround(world);
  const BodyId a = addBody(world, Box{Vec3(1, 0.1, 0.1)}, Vec3(0, 2, 0));
  const BodyId b = addBody(world, Box{Vec3(0.1, 1, 0.1)}, Vec3(0.55, 2.45, 0));
  WeldDef weld;
  weld.bodies = {a, b};
  add(world, weld);
  world.setVelocity(a, {Vec3(0, 0, 3), Vec3(1, 2, 3)});
  const auto apart = [&] {
    const Pose &p = world.bodies().pose[a], &q = world.bodies().pose[b];
    return Vec3(p.q.conjugate() * (q.x - p.x));
  };
  run(world, 180);
  EXPECT_NEAR((apart() - Vec3(0.55, 0.45, 0)).norm(), 0, 2e-3);
  EXPECT_LT(world.bodies().pose[a].q.angularDistance(world.bodies().pose[b].q), 2e-3);
}

// Of two balls that fall side by side the clay one stays and the rubber one comes back.
TEST(Restitution, IsOfEachBodyWhereItSaysSo) {
  for (Settings settings : {onDefaults(), grounded()}) {
    settings.substeps = 8;
    World world(settings);
    addGround(world);
    BodyDef def;
    def.shape = Sphere{0.1};
    def.pose.x = Vec3(0, 1.1, 0);
    const BodyId clay = world.add(def);
    def.pose.x.x() = 1;
    def.restitution = 0.8;
    const BodyId rubber = world.add(def);
    double clayTop = 0, rubberTop = 0;
    for (int i = 0; i < 60; ++i) {
      world.step();
      if (i < 30) continue;
      clayTop = std::max(clayTop, world.bodies().pose[clay].x.y() - 0.1);
      rubberTop = std::max(rubberTop, world.bodies().pose[rubber].x.y() - 0.1);
    }
    EXPECT_LT(clayTop, 0.02);
    EXPECT_NEAR(rubberTop, 0.64, 0.02);  // e^2 of the height
  }
}

TEST(Restitution, OfABodyMustLieBetweenZeroAndOne) {
  World world(onDefaults());
  BodyDef def;
  def.restitution = 1.5;
  EXPECT_THROW(world.add(def), std::invalid_argument);
}

}  // namespace
}  // namespace physics::testing
