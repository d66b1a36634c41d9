// An effect that a scene does not call for, or that cannot matter in it, costs no call and no byte
// and changes no bit.
#include <gtest/gtest.h>

#include "physics/make/rope.h"
#include "physics/world/measure.h"
#include "tests/physics/stage.h"
#include "tests/physics/sweeps.h"

namespace physics {
namespace {

using namespace testing;

std::size_t held(const World& world, const std::string& effect) {
  for (const EffectMemory& memory : world.memory()) {
    if (memory.effect == effect) return memory.bytes;
  }
  return 0;
}

World makeChain(const Settings& settings) {
  World world(settings);
  ChainDef def;
  def.from = Vec3(0, 5, 0);
  def.direction = Vec3(1, 0, 0);
  def.matter.mass = 1;
  def.length = 0.2;
  add(world, def);
  return world;
}

Settings falling() {
  Settings settings = sweeps();
  settings.gravity = Vec3(0, -9.81, 0);
  return settings;
}

StepWork workOf(World& world, int steps) {
  StepWork sum;
  for (int k = 0; k < steps; ++k) {
    const StepWork work = world.step().work;
    sum.broadPhase += work.broadPhase;
    sum.narrowPhase += work.narrowPhase;
    sum.contactVisits += work.contactVisits;
    sum.frictionRows += work.frictionRows;
    sum.turns += work.turns;
    sum.gyroscopic += work.gyroscopic;
    sum.moves += work.moves;
    sum.restSpeeds += work.restSpeeds;
  }
  return sum;
}

TEST(UnusedEffects, AChainWithoutContactsCallsNoCollisionAndHoldsNoneOfIt) {
  World world = makeChain(falling());
  const StepWork work = workOf(world, 30);
  EXPECT_EQ(work.broadPhase + work.narrowPhase + work.contactVisits + work.frictionRows, 0);
  EXPECT_EQ(work.restSpeeds, 0);
  for (const char* effect :
       {"contact", "restitution", "stepping", "direct", "sleep", "spring", "local_substeps"}) {
    EXPECT_EQ(held(world, effect), 0u) << effect;
  }
  EXPECT_GT(held(world, "ball_socket"), 0u);
  EXPECT_GT(held(world, "gyroscopic"), 0u);  // its links are capsules
}

TEST(UnusedEffects, ContactWhereEveryPairIsIgnoredLooksForNothing) {
  Settings settings = falling();
  World without(settings);
  settings.contact = ContactSettings{};
  World with(settings);
  for (World* world : {&without, &with}) {
    addBody(*world, Sphere{}, Vec3(0, 0, 0));
    addBody(*world, Sphere{}, Vec3(0.8, 0, 0));
    world->ignoreCollision(1, 2);
  }
  const StepWork work = workOf(with, 30);
  workOf(without, 30);
  EXPECT_EQ(work.broadPhase + work.narrowPhase + work.contactVisits, 0);
  EXPECT_EQ(stateHash(with), stateHash(without));
}

TEST(UnusedEffects, ContactOfPointsAloneLooksForNothing) {
  Settings settings = falling();
  settings.contact = ContactSettings{};
  World world(settings);
  for (int k = 0; k < 3; ++k) addBody(world, PointShape{}, Vec3(k, 0, 0));
  EXPECT_EQ(workOf(world, 10).broadPhase, 0);
}

TEST(UnusedEffects, ContactThatCanHappenIsLookedFor) {
  Settings settings = falling();
  settings.contact = ContactSettings{};
  World world(settings);
  for (int k = 0; k < 2; ++k) addBody(world, Sphere{}, Vec3(3 * k, 0, 0));
  EXPECT_GT(workOf(world, 10).broadPhase, 0);
}

TEST(UnusedEffects, PointsDoNotTurn) {
  World world(falling());
  RopeDef def;
  def.to = Vec3(1, 0, 0);
  add(world, def);
  const StepWork work = workOf(world, 10);
  EXPECT_GT(work.moves, 0);
  EXPECT_EQ(work.turns + work.gyroscopic, 0);
  EXPECT_EQ(held(world, "gyroscopic"), 0u);
}

TEST(UnusedEffects, SpheresTurnWithoutAGyroscopicTorqueAndBoxesWithOne) {
  World spheres(falling()), boxes(falling());
  addBody(spheres, Sphere{}, Vec3::Zero());
  addBody(boxes, Box{Vec3(1, 2, 3)}, Vec3::Zero());
  const StepWork ofSpheres = workOf(spheres, 10), ofBoxes = workOf(boxes, 10);
  EXPECT_EQ(ofSpheres.gyroscopic, 0);
  EXPECT_GT(ofSpheres.turns, 0);
  EXPECT_EQ(ofBoxes.gyroscopic, ofBoxes.turns);
}

// By the general way an isotropic body turns as by the short one, but for rounding.
TEST(UnusedEffects, TheGyroscopicTorqueOfAnIsotropicBodyIsZero) {
  Settings settings = falling();
  World shorter(settings);
  settings.leavesOut = false;
  World general(settings);
  for (World* world : {&shorter, &general}) {
    addBody(*world, Box{Vec3(1, 1, 1)}, Vec3::Zero());
    world->setVelocity(1, {Vec3::Zero(), Vec3(3, -5, 2)});
    run(*world, 120);
  }
  EXPECT_LT((shorter.bodies().velocity[1].w - general.bodies().velocity[1].w).norm(), 1e-12);
  EXPECT_LT(shorter.bodies().pose[1].q.angularDistance(general.bodies().pose[1].q), 1e-12);
}

TEST(UnusedEffects, FrictionOfNoneHasNoRowsAndNoEffect) {
  Settings settings = grounded();
  settings.contact->friction = {0, 0};
  World shorter(settings);
  settings.leavesOut = false;
  World general(settings);
  for (World* world : {&shorter, &general}) {
    addGround(*world);
    addStack(*world, 2);
    world->setVelocity(2, {Vec3(1, 0, 0.5), Vec3::Zero()});
  }
  EXPECT_EQ(workOf(shorter, 60).frictionRows, 0);
  EXPECT_GT(workOf(general, 60).frictionRows, 0);
  EXPECT_LT(furthest(shorter, general), 1e-9);
}

TEST(UnusedEffects, RestitutionOfWhatNeverTouchesChangesNoBit) {
  Settings settings = grounded();
  World without(settings);
  settings.contact->restitution = 0.5;
  World with(settings);
  for (World* world : {&without, &with}) {
    for (int k = 0; k < 3; ++k) addBody(*world, Box{Vec3(1, 2, 3)}, Vec3(10 * k, 0, 0));
    world->setVelocity(2, {Vec3(0, 5, 0), Vec3(1, 2, 3)});
    run(*world, 60);
  }
  EXPECT_EQ(stateHash(with), stateHash(without));
}

TEST(UnusedEffects, DeclaredAndNeverUsedTheyChangeNoBit) {
  const auto hashOf = [](const Settings& settings) {
    World world = makeChain(settings);
    run(world, 60);
    return stateHash(world);
  };
  const std::uint64_t hash = hashOf(falling());
  Settings sleeps = falling();
  sleeps.sleep = SleepSettings{};
  EXPECT_EQ(hashOf(sleeps), hash);
  Settings local = falling();
  local.localSubsteps = true;  // one island: all its substeps
  local.localTolerance = 1e-12;
  EXPECT_EQ(hashOf(local), hash);
}

}  // namespace
}  // namespace physics
