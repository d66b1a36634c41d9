// Forces, motors and drives that follow a table over time, against their integrals.
#include "physics/constraints/over_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/physics/points.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

// Kinks that are at no step's end, and a jump.
OverTime swelling() { return {{{0.103, 0}, {0.171, 3}, {0.171, -1}, {0.397, 2}}, false}; }

// Twice the integral of a table, by its definition: trapezoids between its own points.
struct Twice {
  double speed = 0, way = 0;
};
Twice integrate(const OverTime& table, double until) {
  constexpr int kParts = 400000;
  const double h = until / kParts;
  Twice sum;
  for (int k = 0; k < kParts; ++k) {
    const double change = h * valueAt(table, (k + 0.5) * h);
    sum.way += h * (sum.speed + 0.5 * change);
    sum.speed += change;
  }
  return sum;
}

ForceDef pushOf(BodyId body, const OverTime& table) {
  ForceDef force;
  force.bodies = {body};
  force.force = Vec3(0, 6, 0);
  force.overTime = table;
  return force;
}

TEST(OverTime, IsLinearBetweenItsPointsAndConstantOutside) {
  const OverTime table{{{1, 2}, {3, 6}}, false};
  EXPECT_DOUBLE_EQ(valueAt(table, 0), 2);
  EXPECT_DOUBLE_EQ(valueAt(table, 1.5), 3);
  EXPECT_DOUBLE_EQ(valueAt(table, 9), 6);
  EXPECT_DOUBLE_EQ(meanOf(table, 0, 5), (2 + 2 * 4 + 2 * 6) / 5.0);
  EXPECT_DOUBLE_EQ(nextPoint(table, 1), 3);
  EXPECT_EQ(nextPoint(table, 3), std::numeric_limits<double>::infinity());
}

TEST(OverTime, RepeatsInBothDirections) {
  const OverTime saw{{{1, 0}, {3, 4}}, true};
  for (const double time : {-3.5, 0.5, 2.5, 100.5}) EXPECT_NEAR(valueAt(saw, time), 3, 1e-12);
  EXPECT_NEAR(meanOf(saw, 0.25, 2000.25), 2, 1e-12);
  EXPECT_NEAR(meanOf(saw, 2.5, 3.5), (0.5 * 3.5 + 0.5 * 0.5), 1e-12);
  EXPECT_NEAR(nextPoint(saw, 3.5), 5, 1e-12);
}

TEST(OverTime, RefusesWhatIsNoTable) {
  EXPECT_THROW(check({{}, false}), std::invalid_argument);
  EXPECT_THROW(check({{{1, 0}, {0, 0}}, false}), std::invalid_argument);
  EXPECT_THROW(check({{{0, 1}, {0, 2}}, true}), std::invalid_argument);
  EXPECT_THROW(check({{{0, NAN}}, false}), std::invalid_argument);
}

// Whatever the substeps: each is given the mean over itself.
TEST(OverTime, AForceGivesItsWholeImpulseByEveryMethod) {
  const double speed = 6 / 1.5 * integrate(swelling(), 0.5).speed;
  for (const Method method :
       {Method::kSmallSteps, Method::kNonlinearGaussSeidel, Method::kDirect,
        Method::kLinearGaussSeidel, Method::kXpbd, Method::kSequentialImpulses}) {
    for (const int substeps : {1, 3}) {
      Settings settings = steps(substeps, 1);
      settings.method = method;
      World world(settings);
      const BodyId body = world.add(point(1.5, Vec3::Zero()));
      world.add(pushOf(body, swelling()));
      for (int k = 0; k < 30; ++k) world.step();
      EXPECT_NEAR(world.bodies().velocity[body].v.y(), speed, 1e-9)
          << static_cast<int>(method) << " with " << substeps;
    }
  }
}

// The steps end where the table has a point, so that none is rejected for it.
TEST(OverTime, AnAccuracyIsKeptOverItsPoints) {
  const Twice exact = integrate(swelling(), 0.5);
  for (const bool joined : {false, true}) {
    Settings settings;
    settings.accuracy = 1e-6;
    World world(settings);
    BodyDef ball = point(1.5, Vec3::Zero());
    ball.shape = Sphere{0.1};
    const BodyId body = world.add(ball);
    world.add(pushOf(body, swelling()));
    if (joined) {  // to another by a spring that is at ease: both go as one of twice the mass
      ball.pose.x = Vec3(1, 0, 0);
      world.add(pushOf(world.add(ball), swelling()));
      SpringDef spring;
      spring.bodies = {1, 2};
      spring.stiffness = 100;
      world.add(spring);
    }
    int rejected = 0;
    for (int k = 0; k < 30; ++k) rejected += world.step().accuracy.rejected;
    EXPECT_EQ(rejected, 0);
    EXPECT_NEAR(world.bodies().velocity[body].v.y(), 4 * exact.speed, 1e-9);
    EXPECT_NEAR(world.bodies().pose[body].x.y(), 4 * exact.way, 1e-9);
  }
}

TEST(OverTime, AMotorTurnsByTheIntegralOfItsSpeed) {
  const double angle = 2 * integrate(swelling(), 0.5).speed;
  for (const std::optional<double> accuracy : {std::optional<double>{}, {1e-4}}) {
    Settings settings = steps(2, 1);
    settings.method = Method::kSmallSteps;
    settings.accuracy = accuracy;
    World world(settings);
    BodyDef wheel = point(1, Vec3::Zero());
    wheel.shape = Sphere{0.5};
    const BodyId body = world.add(wheel);
    MotorDef motor;
    motor.bodies = {kWorldBody, body};
    motor.axis = Vec3::UnitZ();
    motor.speed = 2;
    motor.overTime = swelling();
    world.add(motor);
    for (int k = 0; k < 30; ++k) world.step();
    EXPECT_NEAR(logarithm(world.bodies().pose[body].q).z(), angle, 1e-6);
  }
}

TEST(OverTime, AMotorTorqueTurnsByItsWholeImpulse) {
  World world(steps(2, 1));
  BodyDef wheel = point(1, Vec3::Zero());
  wheel.shape = Sphere{0.5};
  wheel.inertia = Vec3::Constant(0.4);
  const BodyId body = world.add(wheel);
  MotorTorqueDef motor;
  motor.bodies = {kWorldBody, body};
  motor.axis = Vec3::UnitZ();
  motor.stallTorque = 2;
  motor.overTime = swelling();
  world.add(motor);
  for (int k = 0; k < 30; ++k) world.step();
  EXPECT_NEAR(world.bodies().velocity[body].w.z(), 2 / 0.4 * integrate(swelling(), 0.5).speed,
              1e-9);
}

// In any frames of the bodies: it is the turn from the start that is scaled.
TEST(OverTime, ADriveGoesFromItsStartToItsTarget) {
  Settings settings = steps(4, 1);
  settings.method = Method::kSmallSteps;
  World world(settings);
  BodyDef arm = point(0.1, Vec3::Zero());
  arm.shape = Sphere{0.2};
  arm.pose.q = about({1, 0, 0}, 0.7);
  const BodyId body = world.add(arm);
  DriveDef drive;
  drive.bodies = {kWorldBody, body};
  drive.target = about({0, 0, 1}, 1.2) * arm.pose.q;
  drive.stiffness = 100;
  drive.damping = 2;
  drive.overTime = OverTime{{{0, 0}, {1, 0.5}}, false};
  world.add(drive);
  for (int k = 0; k < 180; ++k) world.step();
  const Vec3 turned = logarithm(world.bodies().pose[body].q * arm.pose.q.conjugate());
  EXPECT_LT((turned - Vec3(0, 0, 0.6)).norm(), 1e-6);
  drive.target.reset();
  EXPECT_THROW(world.add(drive), std::invalid_argument);
}

TEST(OverTime, WhatWaitsForItsForceDoesNotSleepBefore) {
  Settings settings = sleeping();
  settings.gravity.reset();
  World world(settings);
  const BodyId body = addBody(world, Box{Vec3(1, 0.1, 0.1)}, Vec3::Zero());
  world.add(pushOf(body, {{{2, 0}, {2, 1}, {2.1, 1}, {2.1, 0}}, false}));
  EXPECT_EQ(run(world, 110).asleep, 0);
  run(world, 30);
  EXPECT_GT(world.bodies().velocity[body].v.y(), 0.1);
}

}  // namespace
}  // namespace physics::testing
