// Sleep of what constraints hold: chains, drives, ropes, and the second-order steppings.
#include <gtest/gtest.h>

#include "physics/make/rope.h"
#include "tests/physics/stage.h"

namespace physics {
namespace {

using namespace testing;

ChainDef hanging(double x = 0) {
  ChainDef def;
  def.from = Vec3(x, 5, 0);
  def.count = 5;
  def.length = 0.4;
  def.matter.mass = 1;
  return def;
}

TEST(SleepOfJoints, AChainThatHangsStillSleepsAndSwingsWhenItIsPushed) {
  for (const Method method : {Method::kNonlinearGaussSeidel, Method::kDirect}) {
    Settings settings = sleeping();
    settings.method = method;
    World world(settings);
    const std::vector<BodyId> links = add(world, hanging());
    EXPECT_EQ(run(world, 90).asleep, 5);
    EXPECT_EQ(run(world, 1).constraintEvaluations, 0);
    world.applyForce(links.back(), Vec3(200, 0, 0), Vec3::Zero());
    EXPECT_EQ(run(world, 1).asleep, 0);
    run(world, 20);
    EXPECT_GT(world.bodies().pose[links.back()].x.x(), 0.2);
    EXPECT_LT(world.constraintErrors()[0].largest, 0.02);
  }
}

// One chain sleeps, its neighbour swings: the neighbour moves as it does alone.
TEST(SleepOfJoints, WhatIsAwakeMovesAsIfTheRestWereNotThere) {
  for (const Method method : {Method::kNonlinearGaussSeidel, Method::kDirect}) {
    Settings settings = sleeping();
    settings.method = method;
    World both(settings), alone(settings);
    const BodyId swings = add(both, hanging()).back();
    add(both, hanging(10));
    add(alone, hanging());
    for (World* world : {&both, &alone}) {
      world->setVelocity(swings, {Vec3(3, 0, 0), Vec3::Zero()});
      run(*world, 120);
    }
    EXPECT_EQ(run(both, 1).asleep, 5);
    run(alone, 1);
    const Pose &p = both.bodies().pose[swings], &q = alone.bodies().pose[swings];
    EXPECT_LT((p.x - q.x).norm(), 1e-12);
  }
}

TEST(SleepOfJoints, ADriveWakesByANewTargetAndNotByTheSame) {
  World world(sleeping());
  const BodyId arm = addBody(world, Box{Vec3(1, 0.1, 0.1)}, Vec3::Zero());
  DriveDef drive;
  drive.bodies = {kWorldBody, arm};
  drive.stiffness = 1000;
  drive.damping = 100;
  world.add(drive);
  BallSocketDef socket;
  socket.bodies = {kWorldBody, arm};
  world.add(socket);
  ASSERT_EQ(run(world, 90).asleep, 1);
  world.setDriveTarget(0, Quat::Identity());
  EXPECT_EQ(run(world, 1).asleep, 1);
  world.setDriveTarget(0, Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ())));
  EXPECT_EQ(run(world, 1).asleep, 0);
  run(world, 120);
  EXPECT_LT(world.driveError(0).norm(), 0.01);
}

TEST(SleepOfJoints, SecondOrderSteppingsSleepAndWakeWithTheirPast) {
  for (const Stepping stepping : {Stepping::kBdf2, Stepping::kSymmetric}) {
    Settings settings = sleeping();
    settings.stepping = stepping;
    World world(settings);
    addGround(world);
    addStack(world, 2);
    const BodyId third = addBody(world, Box{Vec3(0.8, 0.8, 0.8)}, Vec3(0, 7.5, 0));
    EXPECT_EQ(run(world, 55).asleep, 2);
    run(world, 60);
    EXPECT_FALSE(run(world, 1).notFinite);
    EXPECT_NEAR(world.bodies().pose[third].x.y(), 2.4, 1e-3);
    EXPECT_LT(world.largestOverlap(), 1e-3);
    EXPECT_EQ(run(world, 240).asleep, 3);
  }
}

TEST(SleepOfJoints, ARopeOnTheGroundSleepsUntilABoxLandsOnIt) {
  Settings settings = sleeping();
  settings.substeps = 8;
  World world(settings);
  addGround(world);
  RopeDef def;
  def.from = Vec3(-0.5, 0.02, 0);
  def.to = Vec3(0.5, 0.02, 0);
  def.count = 6;
  const std::vector<BodyId> nodes = add(world, def);
  const BodyId box = addBody(world, Box{Vec3(0.5, 0.5, 0.5)}, Vec3(0, 4, 0));
  EXPECT_EQ(run(world, 45).asleep, static_cast<int>(nodes.size()));
  int least = 99;
  for (int k = 0; k < 60; ++k) least = std::min(least, world.step().asleep);
  EXPECT_EQ(least, 0);
  EXPECT_GT(world.bodies().pose[box].x.y(), 0.2);
}

}  // namespace
}  // namespace physics
