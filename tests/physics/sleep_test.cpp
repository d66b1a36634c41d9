// Sleep: who falls asleep, what it costs, what wakes it, and that it changes next to nothing.
#include <gtest/gtest.h>

#include "physics/world/measure.h"
#include "tests/physics/stage.h"

namespace physics {
namespace {

using namespace testing;

int asleep(const World& world) {
  int count = 0;
  for (BodyId i = 0; i < world.bodyCount(); ++i) count += world.isAsleep(i);
  return count;
}

World makeStack(const Settings& settings, int count = 4) {
  World world(settings);
  addGround(world);
  addStack(world, count);
  return world;
}

TEST(Sleep, AStackAtRestSleepsAfterTheTimeItWasGiven) {
  World world = makeStack(sleeping());
  EXPECT_EQ(run(world, 29).asleep, 0);  // 0.5 s are 30 steps, and the first may still settle
  EXPECT_EQ(run(world, 10).asleep, 4);
  EXPECT_EQ(asleep(world), 4);
}

TEST(Sleep, AStackAsleepCostsNoWork) {
  World world = makeStack(sleeping());
  run(world, 60);
  const StepReport report = run(world, 2);
  EXPECT_EQ(report.asleep, 4);
  EXPECT_EQ(report.constraintEvaluations, 0);
  EXPECT_EQ(report.work.moves + report.work.contactVisits + report.work.narrowPhase +
                report.work.broadPhase + report.work.restSpeeds,
            0);
}

// Awake, a stack at rest goes on by less than 1e-6 m in 10 s (measured 2e-9).
TEST(Sleep, StandsWhereItWouldHaveStoodAwake) {
  Settings awake = grounded(), still = sleeping();
  awake.iterations = still.iterations = 400;
  World without = makeStack(awake, 2), with = makeStack(still, 2);
  run(without, 600);
  run(with, 600);
  ASSERT_EQ(asleep(with), 2);
  EXPECT_LT(furthest(without, with), 1e-6);
  EXPECT_EQ(with.contactCount(), without.contactCount());
  EXPECT_NEAR(with.largestOverlap(), without.largestOverlap(), 1e-6);
}

TEST(Sleep, ABodyThatOnlyPassesZeroSpeedDoesNotSleep) {
  Settings settings = sleeping();
  World world(settings);
  addGround(world);
  const BodyId ball = addBody(world, Sphere{0.5}, Vec3(0, 3, 0));
  world.setVelocity(ball, {Vec3(0, 2, 0), Vec3::Zero()});
  for (int k = 0; k < 45; ++k) EXPECT_EQ(world.step().asleep, 0);
}

TEST(Sleep, NothingSleepsThatIsStillJoinedToWhatMoves) {
  World world(sleeping());
  addGround(world);
  const BodyId still = addBody(world, Box{Vec3(4, 1, 4)}, Vec3(0, 0.5, 0), 1000);
  const BodyId rolling = addBody(world, Sphere{0.25}, Vec3(-1.9, 1.25, 0), 0.01);
  world.setVelocity(rolling, {Vec3(0.5, 0, 0), Vec3(0, 0, -2)});
  const StepReport report = run(world, 90);
  EXPECT_EQ(report.asleep, 0) << "box " << world.isAsleep(still);
}

// A ball dropped on a stack that sleeps does what it does to one awake: the two differ by what the
// stack would have crept meanwhile, and a hit in its middle, which tips it either way, makes of
// that (measured 1e-9 to 3e-4 m).
TEST(Sleep, ABallWakesTheStackAndEndsAsWithoutSleep) {
  Settings awake = grounded(), asleep = sleeping();
  awake.method = asleep.method = Method::kSmallSteps;
  for (const double height : {7.1, 7.3, 7.5, 7.7, 8.0, 8.3}) {
    World without = makeStack(awake), with = makeStack(asleep);
    for (World* world : {&without, &with}) addBody(*world, Sphere{0.4}, Vec3(0, height, 0), 0.5);
    run(without, 40);
    EXPECT_EQ(run(with, 40).asleep, 4);
    bool woke = false;
    for (int k = 0; k < 60; ++k) {
      without.step();
      woke = with.step().asleep == 0 || woke;
    }
    EXPECT_TRUE(woke) << height;
    EXPECT_LT(furthest(without, with), 1e-3) << height;
  }
}

TEST(Sleep, RemovingTheSupportWakesWhatStandsOnIt) {
  World world = makeStack(sleeping());
  run(world, 60);
  ASSERT_EQ(asleep(world), 4);
  world.setVelocity(2, {Vec3(30, 0, 0), Vec3::Zero()});
  EXPECT_EQ(run(world, 1).asleep, 0);
  const double top = world.bodies().pose[5].x.y();
  run(world, 40);
  EXPECT_LT(world.bodies().pose[5].x.y(), top - 0.5);
}

TEST(Sleep, DominoesThatSleepFallOneAfterTheOther) {
  World world(sleeping());
  addGround(world);
  for (int k = 0; k < 6; ++k) addBody(world, Box{Vec3(0.2, 1, 0.5)}, Vec3(0.6 * k, 0.5, 0));
  const BodyId ball = addBody(world, Sphere{0.6}, Vec3(-10, 0.6, 0), 2);
  world.setVelocity(ball, {Vec3(6, 0, 0), Vec3(0, 0, -10)});
  EXPECT_EQ(run(world, 60).asleep, 6);
  run(world, 180);
  for (BodyId i = 2; i < 8; ++i) EXPECT_LT(world.bodies().pose[i].x.y(), 0.45) << i;
}

TEST(Sleep, AForceWakesWholeIslandsAndNoOthers) {
  World world = makeStack(sleeping());
  addStack(world, 2, 5);
  run(world, 60);
  ASSERT_EQ(asleep(world), 6);
  world.applyForce(7, Vec3(0, 30, 0), Vec3::Zero());
  EXPECT_EQ(run(world, 1).asleep, 4);
  EXPECT_GT(world.bodies().velocity[7].v.y(), 0.1);
}

TEST(Sleep, AKinematicBodyThatComesNearWakes) {
  World world = makeStack(sleeping(), 1);
  const BodyId pusher = addBody(world, Box{}, Vec3(-3, 0.5, 0), 1, Motion::kKinematic);
  run(world, 60);
  ASSERT_EQ(asleep(world), 2);
  world.setVelocity(pusher, {Vec3(1, 0, 0), Vec3::Zero()});
  run(world, 150);
  EXPECT_NEAR(world.bodies().pose[2].x.x() - world.bodies().pose[pusher].x.x(), 1, 0.02);
}

TEST(Sleep, AStateFromOutsideWakesEverything) {
  World world = makeStack(sleeping());
  run(world, 60);
  std::vector<Pose> pose = world.bodies().pose;
  pose[5].x.y() += 1;
  ASSERT_TRUE(world.setState(pose, world.bodies().velocity));
  EXPECT_EQ(asleep(world), 0);
  run(world, 20);
  EXPECT_LT(world.bodies().pose[5].x.y(), pose[5].x.y() - 0.3);
}

TEST(Sleep, IsPartOfTheStateHash) {
  World world = makeStack(sleeping(), 1);
  run(world, 60);
  ASSERT_EQ(asleep(world), 1);
  const Pose before = world.bodies().pose[2];
  const std::uint64_t hash = stateHash(world);
  ASSERT_TRUE(world.setState(world.bodies().pose, world.bodies().velocity));
  ASSERT_TRUE(before.x == world.bodies().pose[2].x &&
              before.q.coeffs() == world.bodies().pose[2].q.coeffs());
  EXPECT_NE(stateHash(world), hash);
}

TEST(Sleep, OffIsAsIfItWereNotThere) {
  Settings off = sleeping();
  off.leavesOut = false;
  Settings without = grounded();
  without.leavesOut = false;
  World p = makeStack(off), q = makeStack(without);
  EXPECT_EQ(run(p, 60).asleep, 0);
  run(q, 60);
  EXPECT_EQ(stateHash(p), stateHash(q));
}

}  // namespace
}  // namespace physics
