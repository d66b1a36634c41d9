// Local substeps: the stiff island gets all, the others as few as keep the tolerance.
#include <gtest/gtest.h>

#include "physics/world/measure.h"
#include "tests/physics/stage.h"

namespace physics {
namespace {

using namespace testing;

constexpr int kMost = 20;

Settings local(bool on = true, int iterations = 64) {
  Settings settings = grounded();
  settings.iterations = iterations;
  settings.substeps = kMost;
  settings.localSubsteps = on;
  return settings;
}

// Links that swing with a ball of 10,000 times their mass at the end: Gauss-Seidel leaves gaps of
// millimetres even with all substeps.
std::vector<BodyId> addHeavyChain(World& world) {
  ChainDef def;
  def.from = Vec3(0, 6, 0);
  def.direction = Vec3(1, 0, 0);
  def.count = 10;
  def.length = 0.3;
  def.matter.mass = 1;
  def.end = ChainEnd{Sphere{0.3}, {}};
  def.end->matter.mass = 1e4;
  return add(world, def);
}

// Boxes that stand alone, out of the chain's reach; the first one's id.
BodyId addBoxes(World& world, int count) {
  BodyId first = 0;
  for (int k = 0; k < count; ++k) {
    const BodyId id = addBody(world, Box{Vec3(1, 1, 1)}, Vec3(20 + 2 * k, 0.5, 0));
    if (k == 0) first = id;
  }
  return first;
}

struct Mixed {
  World world;
  std::vector<BodyId> chain;
  int boxes;
  explicit Mixed(bool on, int count = 8) : world(local(on)), boxes(count) {
    addGround(world);
    chain = addHeavyChain(world);
    addBoxes(world, boxes);
  }
  BodyId firstBox() const { return world.bodyCount() - boxes; }
};

TEST(LocalSubsteps, TheStiffIslandMovesBitForBitAsWithSubstepsEverywhere) {
  Mixed some(true), all(false);
  run(some.world, 120);
  run(all.world, 120);
  for (const BodyId i : some.chain) {
    EXPECT_EQ(some.world.bodies().pose[i].x, all.world.bodies().pose[i].x) << i;
    EXPECT_EQ(some.world.substepsOf(i), kMost);
  }
}

TEST(LocalSubsteps, BoxesThatStandTakeOneAndStandAsWell) {
  Mixed some(true), all(false);
  const StepReport report = run(some.world, 120), every = run(all.world, 120);
  for (int k = 0; k < 8; ++k) EXPECT_EQ(some.world.substepsOf(some.firstBox() + k), 1) << k;
  EXPECT_LT(furthest(some.world, all.world), 1e-4);  // the tolerance
  const auto links = static_cast<std::int64_t>(some.chain.size());
  EXPECT_EQ(report.work.moves, links * kMost + 8);
  EXPECT_EQ(every.work.moves, (links + 8) * kMost);
}

TEST(LocalSubsteps, ABodysOwnNumberIsTheLeastOfItsIsland) {
  World world(local(true, 100));
  addGround(world);
  addStack(world, 2);
  BodyDef def;
  def.shape = Box{Vec3(1, 1, 1)};
  def.pose.x = Vec3(0, 2.5, 0);
  def.substeps = 7;
  world.add(def);
  addStack(world, 1, 10);
  run(world, 120);
  for (BodyId i = 2; i < 5; ++i) EXPECT_EQ(world.substepsOf(i), 7) << i;
  EXPECT_EQ(world.substepsOf(5), 1);
}

TEST(LocalSubsteps, AStiffSpringTakesAsManyAsItsFrequencyAsksFor) {
  World world(local());
  const BodyId ball = addBody(world, Sphere{0.1}, Vec3(0, -1, 0));
  SpringDef spring;
  spring.bodies = {kWorldBody, ball};
  spring.stiffness = 3000;  // w dt = .91: two resolve it to w h <= 1/2
  world.add(spring);
  const BodyId soft = addBody(world, Sphere{0.1}, Vec3(5, -1, 0));
  spring.bodies = {kWorldBody, soft};
  spring.anchors[0] = Vec3(5, 0, 0);
  spring.stiffness = 10;
  world.add(spring);
  run(world, 120);
  EXPECT_EQ(world.substepsOf(ball), 2);
  EXPECT_EQ(world.substepsOf(soft), 1);
}

// The ball flies with one substep a step, the chain with twenty: where they meet they are one.
TEST(LocalSubsteps, IslandsThatMeetTakeTheLargerNumberAndLoseNoMomentum) {
  Settings settings = local();
  settings.gravity.reset();
  World world(settings);
  ChainDef def;
  def.from = Vec3(0, 0, 0);
  def.count = 10;
  def.length = 0.3;
  def.matter.mass = 1;
  def.fixedStart = false;
  def.end = ChainEnd{Sphere{0.3}, {}};
  def.end->matter.mass = 1e4;
  const std::vector<BodyId> links = add(world, def);
  world.setVelocity(links.front(), {Vec3(0, 0, 4), Vec3::Zero()});
  const BodyId ball = addBody(world, Sphere{0.3}, Vec3(-6, -3.3, 0), 50);
  world.setVelocity(ball, {Vec3(4, 0, 0), Vec3::Zero()});
  const Vec3 before = measure(world).linearMomentum;
  int fewest = kMost;
  for (int k = 0; k < 120; ++k) {
    world.step();
    fewest = std::min(fewest, world.substepsOf(ball));
  }
  EXPECT_EQ(fewest, 1);
  EXPECT_LT(world.bodies().velocity[ball].v.x(), 3);  // it hit
  EXPECT_LT((measure(world).linearMomentum - before).norm(), 1e-9);
}

TEST(LocalSubsteps, WorkWithSleepAndWithTheDirectMethod) {
  for (const Method method : {Method::kNonlinearGaussSeidel, Method::kDirect}) {
    Settings settings = local(true, 100);
    settings.sleep = SleepSettings{};
    settings.method = method;
    World world(settings);
    addGround(world);
    addHeavyChain(world);
    addStack(world, 3, 20);
    EXPECT_EQ(run(world, 90).asleep, 3);
    addStack(world, 0);
    const BodyId top = world.bodyCount() - 1;
    world.applyForce(top, Vec3(0, 0, 60), Vec3::Zero());
    EXPECT_EQ(run(world, 1).asleep, 0);
    EXPECT_GT(world.bodies().velocity[top].v.z(), 0.1);
    EXPECT_FALSE(run(world, 30).notFinite);
  }
}

TEST(LocalSubsteps, SwitchedOffAreSubstepsEverywhere) {
  Settings settings = local();
  settings.leavesOut = false;
  World off(settings);
  settings.localSubsteps = false;
  World all(settings);
  for (World* world : {&off, &all}) {
    addGround(*world);
    addBoxes(*world, 3);
    run(*world, 30);
  }
  EXPECT_EQ(stateHash(off), stateHash(all));
}

TEST(LocalSubsteps, AreWhatTheDefaultMethodDoesUnasked) {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  World off(settings);
  settings.localSubsteps = true;
  World on(settings);
  for (World* world : {&off, &on}) {
    addGround(*world);
    addHeavyChain(*world);
    addBoxes(*world, 3);
    run(*world, 60);
  }
  EXPECT_EQ(stateHash(off), stateHash(on));
}

TEST(LocalSubsteps, GiveTheSameBytesTwice) {
  Mixed p(true, 3), q(true, 3);
  run(p.world, 90);
  run(q.world, 90);
  EXPECT_EQ(stateHash(p.world), stateHash(q.world));
}

}  // namespace
}  // namespace physics
