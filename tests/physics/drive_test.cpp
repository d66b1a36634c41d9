// Drive (128)-(132) and motor.
#include <gtest/gtest.h>

#include "physics/make/hinge.h"
#include "physics/world.h"
#include "tests/physics/pair.h"
#include "tests/physics/points.h"

namespace physics::testing {
namespace {

// Torque on body 1 when it is held `degrees` past its target: two bodies of .0222, so I_eff =
// .0111.
double torqueAt(double angle) {
  const BodyOf ball{1, Vec3::Constant(0.0222), {}};
  Bodies bodies = bodiesOf({ball, ball});
  bodies.pose[1].q = bodies.start[1].q = about({0, 0, 1}, angle);
  const Drive drive{{0, 1}, Quat::Identity(), 2, 0, 1};
  const auto lambda = iterate(drive, bodies, 20, kStep);
  return lambda.total.z() / (kStep * kStep);
}

TEST(Drive, TorqueFallsWithTheAngleInsideItsLimit) {
  const double expected = 2 * 0.3 / (1 + 2 * kStep * kStep / 0.0111);  // .571
  EXPECT_NEAR(torqueAt(0.3), -expected, 1e-12);
  EXPECT_NEAR(torqueAt(-0.3), expected, 1e-12);
}

TEST(Drive, TorqueIsTheLimitBeyond) {
  for (const double angle : {0.6, 0.9, 1.2, 3.0}) {
    EXPECT_NEAR(torqueAt(angle), -1, 1e-14);
    EXPECT_NEAR(torqueAt(-angle), 1, 1e-14);
  }
}

TEST(Drive, LimitsTheTorqueByItsLengthInAnyDirection) {
  const BodyOf ball{1, Vec3::Constant(0.0222), {}};
  Bodies bodies = bodiesOf({ball, ball});
  bodies.pose[1].q = bodies.start[1].q = about({1, -2, 2}, 1.5);
  const auto lambda = iterate(Drive{{0, 1}, Quat::Identity(), 2, 0, 1}, bodies, 20, kStep);
  EXPECT_LT((lambda.total / (kStep * kStep) - Vec3(-1, 2, -2) / 3).norm(), 1e-12);
}

BodyDef ballOf(double inertia, double speed) {
  BodyDef def;
  def.shape = Sphere{0.5};
  def.inertia = Vec3::Constant(inertia);
  def.velocity.w = Vec3(0, 0, speed);
  return def;
}

DriveDef driveOf(BodyId a, BodyId b, double targetAngle, double stiffness, double damping) {
  DriveDef def;
  def.bodies = {a, b};
  def.target = about({0, 0, 1}, targetAngle);
  def.stiffness = stiffness;
  def.damping = damping;
  return def;
}

MotorDef motorOf(BodyId a, BodyId b, double maxTorque) {
  MotorDef def;
  def.bodies = {a, b};
  def.axis = Vec3(0, 0, 2);
  def.speed = 5;
  def.maxTorque = maxTorque;
  return def;
}

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double angleAboutZ(const World& world, BodyId body) {
  return logarithm(world.bodies().pose[body].q).z();
}

TEST(Drive, EqualsImplicitEuler) {
  constexpr double kInertia = 0.4, kStiffness = 30, kDamping = 0.5;
  World world(steps(1, 1));
  const BodyId body = world.add(ballOf(kInertia, 2));
  world.add(driveOf(kWorldBody, body, 0.3, kStiffness, kDamping));
  double theta = -0.3, omega = 2;  // of the error
  for (int k = 0; k < 200; ++k) {
    world.step();
    omega = (kInertia * omega - kStep * kStiffness * theta) /
            (kInertia + kStep * kDamping + kStep * kStep * kStiffness);
    theta += kStep * omega;
    ASSERT_NEAR(angleAboutZ(world, body) - 0.3, theta, 1e-12) << "step " << k;
    ASSERT_NEAR(world.bodies().velocity[body].w.z(), omega, 1e-11);
  }
}

TEST(Drive, BetweenTwoBodiesEqualsImplicitEulerOfTheirRelativeTurn) {
  constexpr double kStiffness = 30, kDamping = 0.5, kReduced = 0.4 * 0.1 / (0.4 + 0.1);
  World world(steps(1, 1));
  const BodyId a = world.add(ballOf(0.4, 0)), b = world.add(ballOf(0.1, 3));
  world.add(driveOf(a, b, 0, kStiffness, kDamping));
  double theta = 0, omega = 3;
  for (int k = 0; k < 200; ++k) {
    world.step();
    omega = (kReduced * omega - kStep * kStiffness * theta) /
            (kReduced + kStep * kDamping + kStep * kStep * kStiffness);
    theta += kStep * omega;
    const Quat relative = world.bodies().pose[b].q * world.bodies().pose[a].q.conjugate();
    ASSERT_NEAR(logarithm(relative).z(), theta, 1e-12) << "step " << k;
  }
}

TEST(Drive, ReportsTheTorqueThatTurnedTheBody) {
  World world(steps(1, 1));
  const BodyId body = world.add(ballOf(0.4, 0));
  const int drive = world.add(driveOf(kWorldBody, body, 0.3, 30, 0.5));
  world.step();
  const double change = world.bodies().velocity[body].w.z();
  EXPECT_NEAR(world.driveTorque(drive).z(), 0.4 * change / kStep, 1e-12);
  EXPECT_GT(change, 0);
}

TEST(Drive, FollowsANewTarget) {
  World world(steps(1, 1));
  const BodyId body = world.add(ballOf(0.4, 0));
  const int drive = world.add(driveOf(kWorldBody, body, 0, 30, 3));
  world.setDriveTarget(drive, about({0, 0, 1}, -1));
  for (int k = 0; k < 600; ++k) world.step();
  EXPECT_NEAR(angleAboutZ(world, body), -1, 1e-6);
}

World motorWorld(double maxTorque) {
  World world(steps(1, 1));
  const BodyId body = world.add(ballOf(0.4, 0));
  world.add(motorOf(kWorldBody, body, maxTorque));
  return world;
}

TEST(Motor, GainsSpeedAtItsTorqueLimitUntilItRunsAtSpeed) {
  World world = motorWorld(1.5);  // 1.5/0.4 = 3.75 rad/s^2: at speed after 80 steps
  for (int k = 1; k <= 79; ++k) {
    world.step();
    ASSERT_NEAR(world.bodies().velocity[1].w.z(), 3.75 * k * kStep, 1e-12) << k;
  }
  for (int k = 80; k < 200; ++k) {
    world.step();
    ASSERT_NEAR(world.bodies().velocity[1].w.z(), 5, 1e-12) << k;
  }
}

TEST(Motor, WithoutALimitRunsAtSpeedAfterOneStep) {
  World world = motorWorld(kNoLimit);
  world.step();
  EXPECT_NEAR(world.bodies().velocity[1].w.z(), 5, 1e-13);
}

TEST(Motor, BetweenTwoBodiesSharesTheTurnByTheirInertias) {
  World world(steps(1, 1));
  const BodyId a = world.add(ballOf(0.4, 0)), b = world.add(ballOf(0.1, 0));
  world.add(motorOf(a, b, kNoLimit));
  world.step();
  EXPECT_NEAR(world.bodies().velocity[a].w.z(), -1, 1e-13);
  EXPECT_NEAR(world.bodies().velocity[b].w.z(), 4, 1e-13);
}

// A cart on wheels by the default method: its motors bring it to the speed of their rims.
TEST(Motor, DrivesACartByTheDefault) {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  World world(settings);
  BodyDef ground;
  ground.shape = Plane{};
  ground.motion = Motion::kStatic;
  world.add(ground);
  BodyDef cart;
  cart.shape = Box{Vec3(2, 0.2, 0.8)};
  cart.mass = 100;
  cart.pose.x = Vec3(0, 0.3, 0);
  const BodyId body = world.add(cart);
  BodyId wheel = 0;
  for (const double x : {-0.7, 0.7}) {
    for (const double z : {-0.6, 0.6}) {
      BodyDef def;
      def.shape = Cylinder{0.3, 0.2};
      def.mass = 10;
      def.pose = {Vec3(x, 0.3, z), Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()))};
      wheel = world.add(def);
      HingeDef hinge;
      hinge.bodies = {body, wheel};
      hinge.at = def.pose.x;
      hinge.axis = Vec3(0, 0, -1);
      hinge.motor = HingeMotor{5, 40};
      add(world, hinge);
    }
  }
  for (int k = 0; k < 120; ++k) world.step();
  EXPECT_NEAR(world.bodies().velocity[wheel].w.z(), -5, 0.01);
  EXPECT_NEAR(world.bodies().velocity[body].v.x(), 5 * 0.3, 0.01);
}

}  // namespace
}  // namespace physics::testing
