// Contacts of whole worlds at rest and in one step.
#include "tests/physics/slope.h"

namespace physics::testing {
namespace {

TEST(Contact, ABlockAtRestStaysWithinANanometreForTenSeconds) {
  World world = slopeOf(0, {});
  world.add(box({0.6, 0.4, 0.5}));
  runFor(world, 10);
  EXPECT_LT((place(world) - Vec3(0, 0.2, 0)).norm(), 1e-9);
  EXPECT_LT(logarithm(world.bodies().pose[kBody].q).norm(), 5e-9);
}

TEST(Contact, CarriesTheWeight) {
  World world = slopeOf(0, {});
  BodyDef def = box({0.6, 0.4, 0.5});
  def.mass = 3;
  world.add(def);
  runFor(world, 1);
  Vec3 impulse = Vec3::Zero();
  for (const ContactReport& contact : world.contacts()) {
    impulse += contact.a == kBody ? contact.impulse : -contact.impulse;
  }
  EXPECT_LT((impulse - Vec3(0, 3 * kGravity / 240, 0)).norm(), 1e-9);
}

// NOTES figure 4: three supports push a plank back by the .02 m it would sink, and tilt nothing;
// with clamped increments it would rise by .0238.
TEST(Contact, APlankOnThreeSupportsIsPushedBackByItsOverlapAndNoMore) {
  Settings settings = slopeOf(0, {0, 0}, 1).settings();
  settings.gravity.reset();
  settings.iterations = 100;
  World world(settings);
  BodyDef support = box({0.1, 1, 0.5});
  support.motion = Motion::kStatic;
  for (const double x : {-1.0, 0.0, 1.0}) {
    support.pose.x.x() = x;
    world.add(support);
  }
  BodyDef plank = box({2.4, 0.1, 0.5});
  plank.pose.x.y() = 1.05;
  plank.velocity.v = Vec3(0, -0.02 * 60, 0);
  const BodyId id = world.add(plank);
  world.step();
  EXPECT_NEAR(world.bodies().pose[id].x.y(), 1.05, 1e-9);
  EXPECT_LT(angleOf(world.bodies().pose[id].q * Vec3::UnitY(), Vec3::UnitY()), 1e-9);
}

TEST(Contact, AHeavyBallRestsOnALightOne) {
  Settings settings = slopeOf(0, {}).settings();
  settings.substeps = 20;
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  world.add(ball(0.5, 0));
  BodyDef heavy = ball(0.5, 0);
  heavy.mass = 100;
  heavy.pose.x.y() = 1.5;
  world.add(heavy);
  runFor(world, 1);
  EXPECT_NEAR(world.bodies().pose[3].x.y(), 1.5, 5e-3);
  EXPECT_LT(world.largestOverlap(), 5e-3);
}

// A rod that whirls about a post, by an accuracy: where its contacts were looked for it has left.
TEST(Contact, WhatHasGonePastDoesNotOverlap) {
  Settings settings;
  settings.contact = ContactSettings{};
  settings.accuracy = 1e-2;
  World world(settings);
  BodyDef post, rod;
  post.shape = Box{Vec3(0.2, 0.2, 0.2)};
  post.motion = Motion::kStatic;
  world.add(post);
  rod.shape = Box{Vec3(1, 0.05, 0.05)};
  rod.pose = {Vec3(0.145, -0.156, -0.358), Quat(0.290, -0.155, -0.250, 0.911).normalized()};
  rod.velocity = {Vec3(-9.12, -1.19, 8.95), Vec3(-11.22, 56.21, -5.81)};
  const BodyId whirls = world.add(rod);
  Collider collider;
  collider.add(0, post.shape, false);
  collider.add(1, rod.shape, true);
  for (int k = 0; k < 2; ++k) world.step();
  double least = 0;
  for (const ContactReport& contact : world.contacts()) least = std::min(least, contact.gap);
  EXPECT_LT(least, -0.05) << "by the points of then";
  EXPECT_GT(collider.distance(0, {}, 1, world.bodies().pose[whirls]), 0.05);
  EXPECT_EQ(world.largestOverlap(), 0);
}

}  // namespace
}  // namespace physics::testing
