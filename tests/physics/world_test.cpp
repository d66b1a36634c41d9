// The World as its callers meet it: determinism, numbers that are not finite, refused arguments.
#include "physics/world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/world/measure.h"
#include "tests/physics/not_a_number.h"
#include "tests/physics/pair.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {
namespace {

BodyDef boxAt(const Vec3& x) {
  BodyDef def;
  def.shape = Box{Vec3(0.5, 0.3, 0.4)};
  def.pose = {x, about({3, 1, 2}, 0.3 + x.y())};
  return def;
}

// Boxes that fall into a heap, two of them jointed.
World heap() {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  for (int k = 0; k < 8; ++k) world.add(boxAt(Vec3(0.1 * (k % 3), 0.6 + 0.5 * k, 0.05 * (k % 2))));
  BallSocketDef joint;
  joint.bodies = {2, 3};
  joint.at = Vec3(0.05, 0.85, 0);
  world.add(joint);
  return world;
}

TEST(Determinism, TwoWorldsInLockstepHaveTheSameHash) {
  World one = heap(), other = heap();
  for (int k = 0; k < 240; ++k) {
    one.step();
    other.step();
    ASSERT_EQ(stateHash(one), stateHash(other)) << "step " << k;
  }
}

TEST(Determinism, TheHashSeesTheLastBitOfAVelocity) {
  World one = heap(), other = heap();
  one.setVelocity(4, {Vec3(1, 0, 0), Vec3::Zero()});
  other.setVelocity(4, {Vec3(std::nextafter(1.0, 2.0), 0, 0), Vec3::Zero()});
  EXPECT_NE(stateHash(one), stateHash(other));
  other.setVelocity(4, {Vec3(1, 0, 0), Vec3::Zero()});
  EXPECT_EQ(stateHash(one), stateHash(other));
  other.setVelocity(4, {Vec3(1, 0, 0), Vec3(0, 0, 1e-300)});
  EXPECT_NE(stateHash(one), stateHash(other));
}

TEST(Determinism, TheHashSeesTheStepCount) {
  World one(Settings{}), other(Settings{});
  one.step();
  EXPECT_NE(stateHash(one), stateHash(other));
}

void expectStateOf(const World& world, const Bodies& before) {
  for (int b = 0; b < world.bodyCount(); ++b) {
    EXPECT_EQ(world.bodies().pose[b].x, before.pose[b].x);
    EXPECT_EQ(world.bodies().pose[b].q.coeffs(), before.pose[b].q.coeffs());
  }
}

TEST(NotFinite, AVelocityIsNamedWithItsBodyAndTheWorldKeepsItsPoses) {
  World world = heap();
  for (int k = 0; k < 5; ++k) world.step();
  const Bodies before = world.bodies();
  world.setVelocity(6, {Vec3(0, kNaN, 0), Vec3::Zero()});
  const StepReport report = world.step();
  ASSERT_TRUE(report.notFinite);
  EXPECT_EQ(report.notFinite->body, 6);
  EXPECT_EQ(report.notFinite->substep, 0);
  expectStateOf(world, before);
}

TEST(NotFinite, ATurnIsNamedWithItsBody) {
  World world = heap();
  world.setVelocity(3, {Vec3::Zero(), Vec3(kNaN, 0, 0)});
  const StepReport report = world.step();
  ASSERT_TRUE(report.notFinite);
  EXPECT_EQ(report.notFinite->body, 3);
}

TEST(NotFinite, AForceIsNamedWithItsBodyAndTheWorldGoesOnFromItsLastGoodState) {
  World world = heap(), untouched = heap();
  for (int k = 0; k < 5; ++k) world.step(), untouched.step();
  const Bodies before = world.bodies();
  world.applyForce(5, Vec3(INFINITY, 0, 0), Vec3::Zero());
  const StepReport report = world.step();
  ASSERT_TRUE(report.notFinite);
  EXPECT_EQ(report.notFinite->body, 5);
  expectStateOf(world, before);
  for (int b = 0; b < world.bodyCount(); ++b) {
    EXPECT_EQ(world.bodies().velocity[b].v, before.velocity[b].v);
    EXPECT_EQ(world.bodies().velocity[b].w, before.velocity[b].w);
  }
  EXPECT_FALSE(world.step().notFinite);  // the force is gone
}

TEST(NotFinite, ATorqueIsNamedWithItsBody) {
  World world = heap();
  world.applyForce(7, Vec3::Zero(), Vec3(0, kNaN, 0));
  const StepReport report = world.step();
  ASSERT_TRUE(report.notFinite);
  EXPECT_EQ(report.notFinite->body, 7);
}

TEST(NotFinite, AJointThatOverflowsIsNamed) {
  World world(sweeps());
  BodyDef ball;
  ball.shape = Sphere{0.1};
  BallSocketDef joint;
  joint.bodies = {world.add(ball), world.add(ball)};
  joint.form = Form::kScalar;
  world.add(joint);
  world.setVelocity(joint.bodies[0], {Vec3(1e200, 0, 0), Vec3::Zero()});
  const StepReport report = world.step();
  ASSERT_TRUE(report.notFinite);
  EXPECT_EQ(report.notFinite->constraint, "ball_socket 0");
  EXPECT_EQ(report.notFinite->body, joint.bodies[0]);
}

TEST(Report, CountsSubstepsAndIterations) {
  Settings settings = sweeps();
  settings.substeps = 5;
  settings.iterations = 3;
  World world(settings);
  const StepReport report = world.step();
  EXPECT_EQ(report.substeps, 5);
  EXPECT_EQ(report.iterations, 15);
  EXPECT_FALSE(report.notFinite);
  EXPECT_EQ(world.stepCount(), 1);
}

}  // namespace
}  // namespace physics::testing
