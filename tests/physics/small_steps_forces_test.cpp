// The default method: forces and limits of joints, whatever the number of substeps.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/world.h"
#include "physics/world/measure.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

class Substeps : public ::testing::TestWithParam<int> {
 protected:
  Settings settings() const {
    Settings settings;
    settings.substeps = GetParam();
    return settings;
  }
};

// A bar of 0.1 m on a drive of 100 N m/rad, pulled down by `load` at its centre.
struct DrivenBar {
  static constexpr double kArm = 0.05, kStiffness = 100;
  World world;
  BodyId bar;

  DrivenBar(const Settings& settings, double mass) : world(settings) {
    bar = addBody(world, Box{Vec3(0.09, 0.02, 0.02)}, Vec3(kArm, 0, 0), mass);
    BallSocketDef socket;
    socket.bodies = {kWorldBody, bar};
    world.add(socket);
    DriveDef drive;
    drive.bodies = {kWorldBody, bar};
    drive.stiffness = kStiffness;
    drive.damping = 1;
    world.add(drive);
  }

  // k phi = F r cos phi, without a speed.
  void expectRest(double load) const {
    double phi = 0;
    for (int k = 0; k < 100; ++k) phi = load * kArm * std::cos(phi) / kStiffness;
    EXPECT_NEAR(world.bodies().pose[bar].x.y(), -kArm * std::sin(phi), 1e-12);
    EXPECT_LT(world.bodies().velocity[bar].v.norm(), 1e-9);
  }
};

TEST_P(Substeps, ADriveHoldsABarUnderItsWeightWhereStaticsSays) {
  Settings settings = Substeps::settings();
  settings.gravity = Vec3(0, -9.81, 0);
  DrivenBar it(settings, 10);
  run(it.world, 600);
  it.expectRest(98.1);
}

// Three balls in a row, on a soft and a stiff spring, and pushed across.
TEST_P(Substeps, SpringsGiveNoAngularMomentum) {
  World world(settings());
  std::vector<BodyId> balls;
  for (int k = 0; k < 3; ++k) balls.push_back(addBody(world, Sphere{0.1}, Vec3(k, 0, 0), 1 + k));
  for (int k = 0; k < 2; ++k) {
    SpringDef spring;
    spring.bodies = {balls[k], balls[k + 1]};
    spring.stiffness = k == 0 ? 50 : 1e8;
    world.add(spring);
  }
  world.setVelocity(balls[0], {Vec3(0, 3, 1), Vec3::Zero()});
  world.setVelocity(balls[2], {Vec3(0.5, -1, 0), Vec3::Zero()});
  const Vec3 before = measure(world).angularMomentum;
  run(world, 600);
  EXPECT_LT((measure(world).angularMomentum - before).norm(), 1e-12 * before.norm());
}

TEST_P(Substeps, ADriveHoldsABarUnderAForceWhereStaticsSays) {
  DrivenBar it(settings(), 0.1);
  ForceDef force;
  force.bodies = {it.bar};
  force.force = Vec3(0, -200, 0);
  it.world.add(force);
  run(it.world, 600);
  it.expectRest(200);
}

// A rod is driven 90 degrees away from where a cone holds it at 30, in every substep: one that did
// not would swing it out and back within a step.
TEST_P(Substeps, AConeHoldsARodThatADrivePulls) {
  World world(settings());
  const BodyId rod = addBody(world, Capsule{0.05, 0.8}, Vec3(0, -0.45, 0), 2);
  BallSocketDef socket;
  socket.bodies = {kWorldBody, rod};
  world.add(socket);
  ConeLimitDef cone;
  cone.bodies = {kWorldBody, rod};
  cone.axis = Vec3(0, -1, 0);
  cone.angle = kPi / 6;
  world.add(cone);
  DriveDef drive;
  drive.bodies = {kWorldBody, rod};
  drive.target = Quat(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  drive.stiffness = 1e4;
  drive.damping = 100;
  world.add(drive);
  run(world, 120);
  EXPECT_NEAR(world.driveTorque(0).norm(), 1e4 * kPi / 3, 10);
}

// Two bars whose ends are an arm apart come together at once, and stand still.
TEST_P(Substeps, WhatBringsJointsTogetherIsNoSpeed) {
  World world(settings());
  const BodyId a = addBody(world, Box{Vec3(0.2, 0.02, 0.02)}, Vec3(0, 0, 0), 1);
  const BodyId b = addBody(world, Box{Vec3(0.02, 0.2, 0.02)}, Vec3(0.25, 0.2, 0), 1);
  BallSocketDef socket;
  socket.bodies = {a, b};
  socket.anchors = std::array{Vec3(0.1, 0, 0), Vec3(0, -0.1, 0)};
  world.add(socket);
  run(world, 1);
  const auto end = [&](BodyId i, const Vec3& anchor) -> Vec3 {
    return world.bodies().pose[i].x + world.bodies().pose[i].q * anchor;
  };
  EXPECT_LT((end(a, Vec3(0.1, 0, 0)) - end(b, Vec3(0, -0.1, 0))).norm(), 1e-6);
  for (const BodyId i : {a, b}) EXPECT_LT(world.bodies().velocity[i].v.norm(), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Counts, Substeps, ::testing::Values(1, 2, 3, 4, 8));

}  // namespace
}  // namespace physics::testing
