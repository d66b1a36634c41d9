// Choices of the solver: regularisation, static steps, relaxation; the self-check.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/constraints/ball_socket.h"
#include "physics/world.h"
#include "tests/physics/pair.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {
namespace {

// A point told to be at 0 and at 1; 200 sweeps. NOTES 3.5
struct Conflict {
  double x = 0, before = 0, first = 0;
};

Conflict conflict(double epsilon, bool damps) {
  Bodies bodies = bodiesOf({{0, Vec3::Zero(), {}}, {1, Vec3::Zero(), at(Vec3(0.3, 0, 0))}});
  const BallSocket zero{{1, 0}, {Vec3::Zero(), Vec3::Zero()}};
  const BallSocket one{{1, 0}, {Vec3::Zero(), Vec3(1, 0, 0)}};
  Multipliers<BallSocket> onZero, onOne;
  Scratch<BallSocket> scratch;
  Conflict end;
  for (int k = 0; k < 200; ++k) {
    solve(zero, onZero, {1, epsilon, damps}, bodies, 1, scratch);
    end.before = bodies.pose[1].x.x();
    solve(one, onOne, {1, epsilon, damps}, bodies, 1, scratch);
  }
  end.x = bodies.pose[1].x.x();
  end.first = onZero.total.x();
  return end;
}

TEST(Regularisation, NowhereCyclesAndItsForceGrowsForEver) {
  const Conflict end = conflict(0, false);
  EXPECT_NEAR(end.before, 0, 1e-12);
  EXPECT_NEAR(end.x, 1, 1e-12);
  EXPECT_GT(std::abs(end.first), 190);
}

TEST(Regularisation, AsDampingSettlesWhileItsForceGrows) {
  const Conflict end = conflict(0.5, true);
  EXPECT_NEAR(end.x, 0.75, 1e-12);
  EXPECT_GT(std::abs(end.first), 90);
}

TEST(Regularisation, AsComplianceIsTheSolutionOf56) {
  const Conflict end = conflict(0.5, false);
  EXPECT_NEAR(end.x, 0.46, 1e-12);
  EXPECT_NEAR(end.first, -0.92, 1e-12);
}

TEST(Regularisation, AsDampingIsExactWhereAnExactSolutionExists) {
  for (const bool damps : {true, false}) {
    Settings settings = sweeps();
    settings.regularisation = 0.05;
    settings.regularisationForm = damps ? Regularisation::kDamping : Regularisation::kCompliance;
    settings.stepping = Stepping::kStatic;
    settings.substeps = 1;
    settings.iterations = 200;
    World world(settings);
    BodyDef def;
    def.pose.x = Vec3(1.5, 0, 0);
    DistanceDef rod;
    rod.bodies = {kWorldBody, world.add(def)};
    rod.length = 1;
    world.add(rod);
    world.step();
    const double error = world.bodies().pose[1].x.x() - 1;
    EXPECT_EQ(std::abs(error) < 1e-14, damps) << error;
    EXPECT_EQ(error > 1e-2, !damps) << error;
  }
}

TEST(StaticSteps, AreTheIterationsOfOneSolve) {
  const auto build = [](int iterations) {
    Settings settings = sweeps();
    settings.stepping = Stepping::kStatic;
    settings.substeps = 1;
    settings.iterations = iterations;
    World world(settings);
    BodyDef pin, node;
    pin.motion = Motion::kStatic;
    pin.pose.x = Vec3(-0.98, 0, 0);
    node.pose.x = Vec3(0, -0.25, 0);
    node.velocity.v = Vec3(5, 5, 5);  // a static step takes it away
    LinkDef link;
    link.length = 1;
    link.bodies = {world.add(pin), world.add(node)};
    world.add(link);
    pin.pose.x = Vec3(0.98, 0, 0);
    link.bodies = {world.add(pin), link.bodies[1]};
    world.add(link);
    return world;
  };
  World oneByOne = build(1), atOnce = build(7);
  for (int k = 0; k < 7; ++k) oneByOne.step();
  atOnce.step();
  EXPECT_LT((oneByOne.bodies().pose[2].x - atOnce.bodies().pose[2].x).norm(), 1e-15);
  EXPECT_TRUE(oneByOne.bodies().velocity[2].v.isZero(0));
}

// (53) on links in a row: over-relaxation needs fewer sweeps, and 2 or more does not converge.
TEST(Relaxation, OfOnePointThreeNeedsFewerSweepsThanOne) {
  const auto sweepsTo = [](double relaxation) {
    Settings settings = sweeps();
    settings.stepping = Stepping::kStatic;
    settings.substeps = 1;
    settings.relaxation = relaxation;
    World world(settings);
    BodyDef def;
    def.motion = Motion::kStatic;
    BodyId last = world.add(def);
    def.motion = Motion::kDynamic;
    for (int i = 1; i <= 6; ++i) {
      def.pose.x = Vec3(1.1 * i, 0, 0);
      LinkDef link;
      link.length = 1;
      link.bodies = {last, world.add(def)};
      last = link.bodies[1];
      world.add(link);
    }
    for (int k = 1; k < 2000; ++k) {
      world.step();
      if (world.constraintErrors()[0].largest < 1e-10) return k;
    }
    return 2000;
  };
  EXPECT_LT(sweepsTo(1.3), 0.7 * sweepsTo(1));
  EXPECT_LT(sweepsTo(0.5), 2000);
  EXPECT_GT(sweepsTo(1.95), sweepsTo(1));
}

// Two links that pull one point: each sweep of a solve moves it by less than the one before.
TEST(Tolerance, SweepsUntilNoneMovesABodyFurther) {
  const auto sweepsOf = [](std::optional<double> tolerance, int most) {
    Settings settings = sweeps(2);
    settings.substeps = 1;
    settings.tolerance = tolerance;
    settings.maxIterations = most;
    World world(settings);
    BodyDef pin, node;
    pin.motion = Motion::kStatic;
    node.pose.x = Vec3(0, -0.25, 0);
    const BodyId point = world.add(node);
    for (const double x : {-0.98, 0.98}) {
      pin.pose.x = Vec3(x, 0, 0);
      LinkDef link;
      link.length = 1;
      link.bodies = {world.add(pin), point};
      world.add(link);
    }
    return world.step().iterations;
  };
  EXPECT_EQ(sweepsOf(std::nullopt, 100), 2);
  EXPECT_EQ(sweepsOf(1e-6, 7), 7);
  EXPECT_GT(sweepsOf(1e-3, 1000), 2);
  EXPECT_GT(sweepsOf(1e-6, 1000), sweepsOf(1e-3, 1000));
  EXPECT_LT(sweepsOf(1e-6, 1000), 1000);
}

TEST(GradientError, FindsEveryGradientRight) {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  World world(settings);
  BodyDef def;
  def.shape = Box{Vec3(0.3, 1, 0.2)};
  def.pose.x = Vec3(0.5, 1, 0);
  const BodyId a = world.add(def);
  def.pose.x = Vec3(0.5, 2.1, 0.2);
  const BodyId b = world.add(def);
  BallSocketDef ball;
  ball.bodies = {a, b};
  ball.at = Vec3(0.5, 1.5, 0);
  world.add(ball);
  AxleDef axle;
  axle.bodies = {a, b};
  world.add(axle);
  ConeLimitDef cone;
  cone.bodies = {a, b};
  cone.axis = Vec3::UnitY();
  world.add(cone);
  for (int k = 0; k < 5; ++k) world.step();
  EXPECT_LT(world.gradientError(), 1e-8);
}

}  // namespace
}  // namespace physics::testing
