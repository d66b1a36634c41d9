// Prismatic and universal joints: what they leave free, what they hold, and degenerate cases.
#include <gtest/gtest.h>

#include "physics/make/prismatic.h"
#include "physics/make/universal.h"
#include "physics/world/measure.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

Settings direct(double h) {
  Settings settings;
  settings.dt = h;
  settings.substeps = 1;
  settings.iterations = 8;
  settings.method = Method::kDirect;
  return settings;
}

BodyDef boxAt(const Vec3& x) {
  BodyDef def;
  def.shape = Box{Vec3(0.3, 0.2, 0.1)};
  def.mass = 2;
  def.pose.x = x;
  return def;
}

// A slide along (3, 4, 0)/5 against gravity: the closed form of a mass on a frictionless incline.
TEST(Prismatic, SlidesDownItsAxisAsOnAnInclineWithoutFriction) {
  Settings settings = direct(1e-3);
  settings.gravity = Vec3(0, -9.81, 0);
  World world(settings);
  PrismaticDef joint;
  joint.bodies = {kWorldBody, world.add(boxAt(Vec3(0.1, 0.2, 0.3)))};
  joint.at = Vec3(0.5, 0, 0);
  joint.axis = Vec3(3, 4, 0);
  add(world, joint);
  for (int k = 0; k < 1000; ++k) world.step();
  const Pose& pose = world.bodies().pose[1];
  const Vec3 moved = pose.x - Vec3(0.1, 0.2, 0.3);
  EXPECT_NEAR(moved.dot(Vec3(0.6, 0.8, 0)), -0.5 * 9.81 * 0.8 * 1.001, 1e-9);  // (29): t (t + h)/2
  EXPECT_LT(moved.cross(Vec3(0.6, 0.8, 0)).norm(), 1e-9);
  EXPECT_LT(logarithm(pose.q).norm(), 1e-9);
}

TEST(Prismatic, StopsAtItsLimits) {
  Settings settings = direct(1e-2);
  settings.gravity = Vec3(-3, 0, 0);
  World world(settings);
  PrismaticDef joint;
  joint.bodies = {kWorldBody, world.add(boxAt(Vec3::Zero()))};
  joint.limits = {{-0.4, 0.2}};
  add(world, joint);
  for (int k = 0; k < 300; ++k) world.step();
  EXPECT_NEAR(world.bodies().pose[1].x.x(), -0.4, 1e-9);
  EXPECT_LT(world.bodies().velocity[1].v.norm(), 1e-9);
}

// Two free bodies spin and slide apart; nothing outside acts.
TEST(Prismatic, KeepsMomentaOfAFreePairAndItsTurn) {
  World world(direct(1e-3));
  BodyDef first = boxAt(Vec3::Zero()), second = boxAt(Vec3(0.5, 0.1, 0));
  first.velocity = {Vec3(0, 1, 0), Vec3(1, 2, 3)};
  second.velocity = {Vec3(0.5, 1, 0) + Vec3(1, 2, 3).cross(second.pose.x), Vec3(1, 2, 3)};
  PrismaticDef joint;
  joint.bodies = {world.add(first), world.add(second)};
  add(world, joint);
  const Measures before = measure(world);
  for (int k = 0; k < 200; ++k) world.step();
  const Measures after = measure(world);
  EXPECT_LT((after.linearMomentum - before.linearMomentum).norm(), 1e-11);
  // what the step's own rounding of turns leaves: measured 8e-3 of 8 at h = 1e-3, O(h)
  EXPECT_LT((after.angularMomentum - before.angularMomentum).norm(),
            5e-3 * before.angularMomentum.norm());
  const auto& pose = world.bodies().pose;
  EXPECT_LT(logarithm(pose[1].q * pose[2].q.conjugate()).norm(), 1e-9);
}

// Hooke's joint between shafts at an angle beta: tan(out) = tan(in) cos(beta) for the turn of the
// second shaft when the first turns evenly, from the cross of the first in the plane of the bend.
TEST(Universal, TurnsTheSecondShaftByHookesLaw) {
  const double beta = 35 * kDegree;
  World world(direct(1e-4));
  BodyDef in = boxAt(Vec3(-1, 0, 0));
  in.motion = Motion::kKinematic;
  in.velocity.w = Vec3(2, 0, 0);
  const Vec3 out(std::cos(beta), std::sin(beta), 0);  // the bend is in the plane z = 0
  BodyDef shaft = boxAt(out);
  shaft.pose.q = about({0, 0, 1}, beta);
  shaft.velocity.w = 2 / std::cos(beta) * out;  // Hooke's speed at the start
  const BodyId first = world.add(in), second = world.add(shaft);
  AxleDef bearing;
  bearing.bodies = {kWorldBody, second};
  bearing.axis = out;
  world.add(bearing);
  PerpendicularDef cross;
  cross.bodies = {first, second};
  cross.directions = {Vec3(0, 1, 0), Vec3(0, 0, 1)};
  world.add(cross);
  BallSocketDef place;
  place.bodies = {kWorldBody, second};
  place.at = out;
  world.add(place);
  for (int k = 0; k < 4000; ++k) world.step();
  const Vec3 z = world.bodies().pose[second].q * Vec3::UnitZ();
  const double turned = std::atan2(-z.dot(out.cross(Vec3::UnitZ())) * -1, z.z());
  // the axis of the first in the plane of the bend: tan(turn out) = tan(turn in)/cos(beta)
  EXPECT_NEAR(std::abs(std::tan(turned)), std::abs(std::tan(0.8) / std::cos(beta)), 1e-6);
}

TEST(Universal, RefusesDirectionsThatAreNotAtARightAngle) {
  World world;
  UniversalDef joint;
  joint.bodies = {kWorldBody, world.add(boxAt(Vec3::Zero()))};
  joint.directions = {Vec3(1, 0, 0), Vec3(1, 1, 0)};
  EXPECT_THROW(add(world, joint), std::invalid_argument);
}

TEST(Perpendicular, EndsAtARightAngleFromParallelAndAntiparallel) {
  for (const double turn : {0.0, kPi}) {
    Bodies bodies = bodiesOf({{}, {}});
    bodies.pose[1].q = about({0, 0, 1}, turn);
    iterate(Perpendicular{{0, 1}, {Vec3::UnitX(), Vec3::UnitX()}}, bodies, 5);
    EXPECT_NEAR(angleOf(bodies.pose[0].q * Vec3::UnitX(), bodies.pose[1].q * Vec3::UnitX()),
                0.5 * kPi, 1e-10);
  }
}

// Two isotropic bodies turn about the axis of the error: the exponential is exact, one visit
// serves.
TEST(OrientationLock, ClosesInOneVisitFromAnyTurn) {
  for (const double turn : {1e-300, 1e-9, 0.01, 1.0, 3.0, kPi - 1e-9, kPi}) {
    Bodies bodies = bodiesOf({{}, {3, Vec3(2, 2, 2), {Vec3(1, 2, 3), about({1, -2, 2}, turn)}}});
    iterate(OrientationLock{{0, 1}}, bodies, 1);
    EXPECT_LT(logarithm(bodies.pose[0].q.conjugate() * bodies.pose[1].q).norm(), 1e-10) << turn;
  }
}

}  // namespace
}  // namespace physics::testing
