// Joined bodies in contact gain no energy.
#include <gtest/gtest.h>

#include "physics/constraints/ball_socket.h"
#include "physics/constraints/force.h"
#include "physics/world.h"
#include "physics/world/measure.h"
#include "tests/physics/sweeps.h"

namespace physics {
namespace {

// Three boxes on ball joints, thrown into a corner of three planes, with one sweep a substep:
// joints and contacts disagree at the end of every one.
struct Thrown {
  World world;
  std::vector<BodyId> boxes;

  explicit Thrown(double speed) : world(settings()) {
    for (const Vec3& normal : {Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
      BodyDef wall;
      wall.shape = Plane{normal, 0};
      wall.motion = Motion::kStatic;
      world.add(wall);
    }
    for (int i = 0; i < 3; ++i) {
      BodyDef box;
      box.shape = Box{Vec3(0.5, 0.2, 0.2)};
      box.mass = i == 1 ? 10 : 1;
      box.pose.x = Vec3(1 + 0.5 * i, 1, 1);
      box.velocity.v = speed * Vec3(-1, -0.7, -0.4);
      boxes.push_back(world.add(box));
      if (i == 0) continue;
      BallSocketDef joint;
      joint.bodies = {boxes[i - 1], boxes[i]};
      joint.at = Vec3(0.75 + 0.5 * i, 1, 1);
      world.add(joint);
    }
  }

  static Settings settings() {
    Settings settings = testing::sweeps();
    settings.substeps = 2;
    settings.iterations = settings.maxIterations = 1;
    settings.gravity = Vec3(0, -9.81, 0);
    settings.contact = ContactSettings{};
    settings.contact->friction = {0.5, 0.5};
    return settings;
  }
};

class EnergyBound : public ::testing::TestWithParam<double> {};

// The work of gravity over a substep is h m g.v', not that of the displacement, which corrections
// of overlaps are part of: energy is compared without them, as kinetic energy that gravity's work
// does not explain.
TEST_P(EnergyBound, KineticEnergyRisesByTheWorkOfGravityAtTheMost) {
  Thrown thrown(GetParam());
  World& world = thrown.world;
  int bounded = 0;
  double kinetic = measure(world).kinetic;
  const double start = kinetic, mostGravityDoes = 12 * 9.81 * 2;  // J, a fall of 2 m
  for (int k = 0; k < 120; ++k) {
    const StepReport report = world.step();
    ASSERT_FALSE(report.notFinite);
    bounded += report.bounded;
    kinetic = std::max(kinetic, measure(world).kinetic);
  }
  EXPECT_LT(kinetic, start + mostGravityDoes);
  EXPECT_GT(bounded, 0);  // without the bound this throw gains
}

INSTANTIATE_TEST_SUITE_P(Speeds, EnergyBound, ::testing::Values(10.0, 50.0, 200.0));

// Islands that forces act on are held to the forces' work, not left alone.
TEST_P(EnergyBound, KineticEnergyRisesByTheWorkOfAForceAtTheMost) {
  Thrown thrown(GetParam());
  World& world = thrown.world;
  ForceDef push;
  push.bodies = {thrown.boxes[0]};
  push.force = Vec3(-30, 0, 0);
  world.add(push);
  int bounded = 0;
  double kinetic = measure(world).kinetic;
  const double most = kinetic + 12 * 9.81 * 2 + 30 * 2;  // J
  for (int k = 0; k < 120; ++k) {
    const StepReport report = world.step();
    ASSERT_FALSE(report.notFinite);
    bounded += report.bounded;
    kinetic = std::max(kinetic, measure(world).kinetic);
  }
  EXPECT_LT(kinetic, most);
  EXPECT_GT(bounded, 0);
}

// Two boxes on a ball joint, pulled over the ground: (F - mu m g) / m.
TEST(EnergyBound, LetsAForceDoItsWork) {
  Settings settings = Thrown::settings();
  settings.iterations = settings.maxIterations = 20;
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{Vec3(0, 1, 0), 0};
  ground.motion = Motion::kStatic;
  world.add(ground);
  std::vector<BodyId> boxes;
  for (int i = 0; i < 2; ++i) {
    BodyDef box;
    box.shape = Box{Vec3(0.5, 0.2, 0.5)};
    box.pose.x = Vec3(0.6 * i, 0.1, 0);
    boxes.push_back(world.add(box));
  }
  BallSocketDef joint;
  joint.bodies = {boxes[0], boxes[1]};
  joint.at = Vec3(0.3, 0.1, 0);
  world.add(joint);
  ForceDef pull;
  pull.bodies = {boxes[1]};
  pull.force = Vec3(20, 0, 0);
  world.add(pull);
  for (int k = 0; k < 60; ++k) world.step();
  const double expected = (20 - 0.5 * 2 * 9.81) / 2;  // m/s after 1 s
  for (const BodyId box : boxes) {
    EXPECT_NEAR(world.bodies().velocity[box].v.x(), expected, 0.01 * expected);
  }
}

TEST(EnergyBound, LeavesMotionWithoutContactsAlone) {
  Settings settings = Thrown::settings();
  World world(settings);
  BodyDef box;
  box.shape = Box{};
  box.pose.x = Vec3(0.5, 0, 0);
  const BodyId swinging = world.add(box);
  BallSocketDef joint;
  joint.bodies = {kWorldBody, swinging};
  world.add(joint);
  for (int k = 0; k < 60; ++k) ASSERT_EQ(world.step().bounded, 0);
}

}  // namespace
}  // namespace physics
