// Arms as bodies of a World.
#include <gtest/gtest.h>

#include "physics/kinematics/driven_arm.h"
#include "physics/world/measure.h"
#include "tests/physics/arms.h"
#include "tests/physics/slope.h"

namespace physics::testing {
namespace {

ArmDef reachingArm(const Vec3& at, const Vec3& target) {
  ArmDef def = planarArm(0.05);
  def.at = at;
  def.solve = ArmSolve{};
  def.target = target;
  return def;
}

TEST(ArmInAWorld, IsWhereTheSolutionIsAfterEachStep) {
  Settings settings;
  settings.substeps = 7;
  World world(settings);
  const ArmDef def = reachingArm(Vec3(1, 2, 0), Vec3(1.3, 2.5, 0));
  const int index = world.add(def);
  Arm alone = makeArm(def);
  ArmScratch scratch;
  for (int step = 0; step < 30; ++step) {
    world.step();
    for (int k = 0; k < def.solve.iterations; ++k) {
      if (!iterate(alone, *def.target, def.solve, scratch).moved) break;
    }
    const ArmPosture posture = postureOf(alone);
    const ArmReport report = world.arms()[index];
    for (int k = 0; k < alone.size(); ++k) {
      const Pose expected = linkPose(alone, posture, k);
      const Pose& body = world.bodies().pose[report.bodies[k]];
      EXPECT_LT((body.x - expected.x).norm(), 1e-12);
      EXPECT_LT(logarithm(body.q * expected.q.conjugate()).norm(), 1e-12);
    }
  }
  EXPECT_LT(world.arms()[index].error, 1e-9);
}

TEST(ArmInAWorld, StandsStillOnceItIsThere) {
  World world;
  const ArmDef def = reachingArm(Vec3::Zero(), Vec3(0.8, 0.45, 0));
  world.add(def);
  for (int step = 0; step < 60; ++step) world.step();
  for (const Velocity& velocity : world.bodies().velocity) {
    EXPECT_LT(velocity.v.norm(), 1e-9);
    EXPECT_LT(velocity.w.norm(), 1e-9);
  }
}

TEST(ArmInAWorld, FollowsItsTargetNoFasterThanItMay) {
  World world;
  ArmDef def = reachingArm(Vec3::Zero(), Vec3(0.5, 0.5, 0));
  def.maxSpeed = 0.3;
  const int index = world.add(def);
  Vec3 before = world.arms()[index].followed;
  for (int step = 0; step < 240; ++step) {
    world.step();
    const ArmReport report = world.arms()[index];
    EXPECT_LE((report.followed - before).norm(), 0.3 / 60 + 1e-15);
    EXPECT_LT((report.followed - report.tip).norm(), 0.3 / 60);  // less than a step behind
    before = report.followed;
  }
  EXPECT_LT(world.arms()[index].error, 1e-6);
}

// An arm that lies along x, a hand above the ground, and sweeps to the side where a box stands.
World armAndBox(BodyId& box) {
  World world = slopeOf(0, {0.5, 0.5});
  BodyDef def = testing::box(Vec3::Constant(0.2));
  def.pose.x = Vec3(0.8, 0.1, -0.25);
  box = world.add(def);
  ArmDef arm = reachingArm(Vec3(0, 0.1, 0), Vec3(0.75, 0.1, -0.5));
  for (ArmLinkDef& link : arm.links) {
    link.axis = Vec3::UnitY();
    link.angle = 0.01;
  }
  arm.maxSpeed = 0.5;
  world.add(arm);
  return world;
}

TEST(ArmInAWorld, PushesABoxAndIsNotPushedBack) {
  BodyId box = -1;
  World world = armAndBox(box);
  for (int step = 0; step < 240; ++step) {
    ASSERT_FALSE(world.step().notFinite);
    EXPECT_LT(world.largestOverlap(), 0.01);
  }
  EXPECT_LT(world.bodies().pose[box].x.z(), -0.45);
  EXPECT_LT(world.arms()[0].error, 1e-6);
}

TEST(ArmInAWorld, GivesTheSameBytesEachTime) {
  BodyId box = -1;
  World one = armAndBox(box), other = armAndBox(box);
  for (int step = 0; step < 120; ++step) {
    one.step(), other.step();
    ASSERT_EQ(stateHash(one), stateHash(other));
  }
}

TEST(ArmInAWorld, GoesBackWithTheWorldWhenAStepFails) {
  BodyId box = -1;
  World world = armAndBox(box), untouched = armAndBox(box);
  for (int step = 0; step < 20; ++step) world.step(), untouched.step();
  world.applyForce(box, Vec3(INFINITY, 0, 0), Vec3::Zero());
  ASSERT_TRUE(world.step().notFinite);
  EXPECT_EQ(world.arms()[0].tip, untouched.arms()[0].tip);
  EXPECT_EQ(world.arms()[0].followed, untouched.arms()[0].followed);
}

template <class Change>
std::string refusal(Change change) {
  ArmDef def = planarArm();
  change(def);
  try {
    World().add(def);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ArmInAWorld, RefusesWhatMakesNoSense) {
  EXPECT_EQ(refusal([](ArmDef& d) { d.links[2].length.setZero(); }),
            "link 2: expected a length > 0");
  EXPECT_EQ(refusal([](ArmDef& d) { d.links[1].mass = 0; }), "link 1: expected a mass > 0");
  EXPECT_EQ(refusal([](ArmDef& d) { d.links.clear(); }), "expected at least one link");
  EXPECT_EQ(refusal([](ArmDef& d) {
              d.links[3].range = {0.1, 0.2};
            }),
            "link 3: expected a start within its limits");
  EXPECT_EQ(refusal([](ArmDef& d) { d.links[0].axis.setZero(); }),
            "link 0: expected an axis that is not zero");
  EXPECT_EQ(refusal([](ArmDef& d) {
              d.links[5].centre = Vec3::Zero();
              d.links[5].inertia = Vec3::Zero();
            }),
            "link 5: expected some inertia about its joint: nothing comes after it");
}

}  // namespace
}  // namespace physics::testing
