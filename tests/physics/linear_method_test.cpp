// Linear Gauss-Seidel (51) beside the non-linear method (52).
#include <gtest/gtest.h>

#include <cmath>

#include "physics/world.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

Settings methodOf(Method method, int iterations) {
  Settings settings;
  settings.method = method;
  settings.substeps = 1;
  settings.iterations = iterations;
  return settings;
}

// A rod that hangs on a ball and turns by `turn` radians in the one step that is made.
double jointErrorAfter(Method method, double turn) {
  World world(methodOf(method, 300));
  BodyDef def;
  def.shape = Box{Vec3(0.1, 1, 0.1)};
  def.pose.x = Vec3(0, -0.5, 0);
  def.velocity.w = Vec3(0, 0, 60 * turn);
  BallSocketDef joint;
  joint.bodies = {kWorldBody, world.add(def)};
  joint.at = Vec3::Zero();
  world.add(joint);
  world.step();
  return world.constraintErrors()[0].largest;
}

// NOTES 3.5: the error that linearising leaves grows with the square of the turn and stays there.
TEST(LinearGaussSeidel, LeavesAnErrorThatGrowsWithTheTurnOfTheStep) {
  const double small = jointErrorAfter(Method::kLinearGaussSeidel, 0.1);
  const double large = jointErrorAfter(Method::kLinearGaussSeidel, 0.5);
  EXPECT_GT(small, 1e-6);
  EXPECT_GT(large, 10 * small);
  EXPECT_LT(jointErrorAfter(Method::kNonlinearGaussSeidel, 0.1), 1e-12);
  EXPECT_LT(jointErrorAfter(Method::kNonlinearGaussSeidel, 0.5), 1e-12);
}

TEST(LinearGaussSeidel, EqualsTheNonlinearMethodWhereTheConstraintsAreLinear) {
  const auto place = [](Method method) {
    World world(methodOf(method, 5));
    BodyDef def;
    BallSocketDef joint;
    BodyId last = kWorldBody;
    for (int i = 1; i <= 4; ++i) {  // points: a ball between them is linear in their places
      def.pose.x = Vec3(0.3 * i, 0.1 * i, 0);
      joint.bodies = {last, world.add(def)};
      joint.anchors = {{Vec3(0.2, 0, 0), Vec3::Zero()}};
      last = joint.bodies[1];
      world.add(joint);
    }
    for (int k = 0; k < 10; ++k) world.step();
    return world.bodies().pose[last].x;
  };
  EXPECT_LT((place(Method::kLinearGaussSeidel) - place(Method::kNonlinearGaussSeidel)).norm(),
            1e-13);
}

TEST(LinearGaussSeidel, HoldsABoxOnAPlane) {
  Settings settings = methodOf(Method::kLinearGaussSeidel, 20);
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact.emplace();
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  BodyDef box;
  box.shape = Box{Vec3(1, 0.5, 1)};
  box.pose.x = Vec3(0, 0.25, 0);
  const BodyId id = world.add(box);
  for (int k = 0; k < 120; ++k) world.step();
  EXPECT_LT((world.bodies().pose[id].x - Vec3(0, 0.25, 0)).norm(), 1e-3);
  EXPECT_EQ(world.contactCount(), 4);
}

TEST(LinearGaussSeidel, SlowsASlidingBoxByFriction) {
  Settings settings = methodOf(Method::kLinearGaussSeidel, 20);
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact.emplace();
  settings.contact->friction = {0.5, 0.5};
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  BodyDef box;
  box.shape = Box{Vec3(1, 0.2, 1)};
  box.pose.x = Vec3(0, 0.1, 0);
  box.velocity.v = Vec3(3, 0, 0);
  const BodyId id = world.add(box);
  for (int k = 0; k < 120; ++k) world.step();
  const double exact = 3 * 3 / (2 * 0.5 * 9.81);
  EXPECT_NEAR(world.bodies().pose[id].x.x(), exact, 0.06 * exact);  // less v0 h/2
  EXPECT_LT(world.bodies().velocity[id].v.norm(), 1e-3);
}

}  // namespace
}  // namespace physics::testing
