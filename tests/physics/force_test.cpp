// Non-linear forces, (102)-(107), against implicit Euler and closed forms.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/physics/points.h"

namespace physics::testing {
namespace {

TEST(HardeningSpring, EqualsImplicitEuler) {
  World world(steps(1, 30));
  const BodyId body = world.add(point(2, Vec3(1.6, 0, 0)));
  HardeningSpringDef def;
  def.bodies = {kWorldBody, body};
  def.stiffness = 300;
  def.cubic = 2000;
  def.damping = 1;
  def.restLength = 1;
  world.add(def);
  double s = 0.6, v = 0;
  for (int k = 0; k < 60; ++k) {
    world.step();
    double next = s;  // Newton on m (s' - s - h v)/h^2 = -k s' - k3 s'^3 - nu (s' - s)/h
    for (int i = 0; i < 50; ++i) {
      const double residual = 2 * (next - s - kStep * v) / (kStep * kStep) + 300 * next +
                              2000 * next * next * next + (next - s) / kStep;
      next -= residual / (2 / (kStep * kStep) + 300 + 6000 * next * next + 1 / kStep);
    }
    v = (next - s) / kStep;
    s = next;
    ASSERT_NEAR(world.bodies().pose[body].x.x(), 1 + s, 1e-12) << "step " << k;
  }
}

TEST(HardeningSpring, WithoutItsCubicIsTheLinearOne) {
  World hard(steps(1, 4)), linear(steps(1, 4));
  const auto build = [](World& world, auto def) {
    def.bodies = {kWorldBody, world.add(point(1, Vec3(1.3, 0.1, 0)))};
    def.stiffness = 200;
    def.damping = 2;
    def.restLength = 1;
    if constexpr (requires { def.cubic; }) def.cubic = 0;
    world.add(def);
  };
  build(hard, HardeningSpringDef{});
  build(linear, SpringDef{});
  for (int k = 0; k < 60; ++k) hard.step(), linear.step();
  EXPECT_LT((hard.bodies().pose[1].x - linear.bodies().pose[1].x).norm(), 1e-14);
}

// 1/v = 1/v0 + beta t/m.
double speedAfterOneSecond(int substeps) {
  World world(steps(substeps, 8));
  DragDef drag;
  drag.bodies = {world.add(point(2, Vec3::Zero(), Vec3(20, 0, 0)))};
  drag.coefficient = 0.3;
  world.add(drag);
  for (int k = 0; k < 60; ++k) world.step();
  return world.bodies().velocity[1].v.x();
}

TEST(Drag, TendsToTheClosedFormWithOrderOne) {
  const double exact = 1 / (1 / 20.0 + 0.3 / 2);
  EXPECT_NEAR(speedAfterOneSecond(1), exact, 0.05 * exact);
  const double ratio = (speedAfterOneSecond(4) - exact) / (speedAfterOneSecond(8) - exact);
  EXPECT_NEAR(ratio, 2, 0.05);
}

TEST(Drag, CarriesABodyToTheWindAndNotBeyond) {
  World world(steps(1, 8));
  DragDef drag;
  drag.bodies = {world.add(point(0.01, Vec3::Zero()))};
  drag.coefficient = 5;
  drag.wind = Vec3(3, 0, 4);
  world.add(drag);
  for (int k = 0; k < 600; ++k) {
    world.step();
    ASSERT_LE(world.bodies().velocity[1].v.norm(), 5 * (1 + 1e-12));
  }
  EXPECT_LT((world.bodies().velocity[1].v - drag.wind).norm(), 0.05);
}

TEST(PanelDrag, PushesAlongTheNormalWithTheAreaAndTheSquareOfTheWind) {
  Bodies bodies;
  for (const Vec3& x : {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 1, 0)}) {
    add(bodies, {1e9, Vec3::Zero(), at(x)});  // so heavy that they stay
  }
  const auto lambda = iterate(PanelDrag{{0, 1, 2}, 0.5, Vec3(1, 0, 4)}, bodies, 5, kStep);
  EXPECT_NEAR(lambda.total.z() / (kStep * kStep), 0.5 * 1 * 16, 1e-6);  // beta A (n.u)^2, A = 1
  EXPECT_NEAR(lambda.total.x(), 0, 1e-12);
}

TEST(PanelDrag, OfThreePointsOnALineIsNothing) {
  Bodies bodies;
  for (const double x : {0.0, 1.0, 2.0}) add(bodies, {1, Vec3::Zero(), at(Vec3(x, 0, 0))});
  const auto lambda = iterate(PanelDrag{{0, 1, 2}, 0.5, Vec3(1, 0, 4)}, bodies, 5);
  EXPECT_TRUE(lambda.total.isZero(0));
}

// A circle of radius 1 at speed 1: after one turn, 2 pi s, back where it was as h -> 0.
TEST(PointGravity, KeepsACircularOrbitToFirstOrder) {
  const auto radiusAfterOneTurn = [](int substeps) {
    World world(steps(substeps, 6));
    BodyDef sun = point(1, Vec3::Zero());
    sun.motion = Motion::kStatic;
    PointGravityDef def;
    def.bodies = {world.add(sun), world.add(point(1, Vec3(1, 0, 0), Vec3(0, 0, 1)))};
    def.strength = 1;
    world.add(def);
    for (int k = 0; k < 377; ++k) world.step();
    return world.bodies().pose[2].x.norm();
  };
  const double coarse = radiusAfterOneTurn(4) - 1, fine = radiusAfterOneTurn(8) - 1;
  EXPECT_LT(std::abs(coarse), 0.1);
  EXPECT_NEAR(coarse / fine, 2, 0.1);
}

TEST(PointGravity, IsFiniteForBodiesAtOnePlace) {
  Bodies bodies = bodiesOf({{}, {}});
  Multipliers<PointGravity> lambda;
  EXPECT_TRUE(visit(PointGravity{{0, 1}, 5, 0}, lambda, bodies));
  EXPECT_TRUE(visit(PointGravity{{0, 1}, 5, 0.1}, lambda, bodies));
  EXPECT_TRUE(bodies.pose[0].x.isZero(0));
}

// omega' = (tau_s - tau_s omega/omega_f)/I: omega_f (1 - exp(-t tau_s/(I omega_f))).
TEST(MotorTorque, SpinsUpToItsFreeSpeed) {
  World world(steps(16, 1));
  BodyDef wheel;
  wheel.inertia = Vec3::Constant(0.5);
  wheel.shape = Sphere{};
  MotorTorqueDef def;
  def.bodies = {kWorldBody, world.add(wheel)};
  def.axis = Vec3::UnitY();
  def.stallTorque = -2;
  def.freeSpeed = 10;
  world.add(def);
  for (int k = 0; k < 120; ++k) world.step();
  const double exact = -10 * (1 - std::exp(-2 * 2 / (0.5 * 10)));
  EXPECT_NEAR(world.bodies().velocity[1].w.y(), exact, 1e-3 * 10);
}

TEST(MotorTorque, WithoutAFreeSpeedIsAConstantTorque) {
  World world(steps(1, 1));
  BodyDef wheel;
  wheel.inertia = Vec3::Constant(0.5);
  wheel.shape = Sphere{};
  MotorTorqueDef def;
  def.bodies = {kWorldBody, world.add(wheel)};
  def.stallTorque = 2;
  world.add(def);
  for (int k = 0; k < 60; ++k) world.step();
  EXPECT_NEAR(world.bodies().velocity[1].w.x(), 4, 1e-9);
}

// A cantilever of n pieces under a weight F at its end sinks by F L^3/(3 E I), Euler and Bernoulli.
double sag(int pieces) {
  const double length = 1, rigidity = 2, force = 0.01, piece = length / pieces;
  Settings settings = steps(1, 300);
  settings.stepping = Stepping::kStatic;
  World world(settings);
  std::vector<BodyId> nodes;
  for (int i = -1; i <= pieces; ++i) {
    BodyDef def = point(0.01, Vec3(i * piece, 0, 0));
    if (i <= 0) def.motion = Motion::kStatic;
    nodes.push_back(world.add(def));
  }
  BendDef bend;
  bend.stiffness = rigidity / (piece * piece * piece);
  for (int i = 0; i + 2 < static_cast<int>(nodes.size()); ++i) {
    bend.bodies = {nodes[i], nodes[i + 1], nodes[i + 2]};
    world.add(bend);
  }
  for (int k = 0; k < 400; ++k) {
    world.applyForce(nodes.back(), Vec3(0, -force, 0), Vec3::Zero());
    world.step();
  }
  return -world.bodies().pose[nodes.back()].x.y() / (force / (3 * rigidity));
}

// The discrete beam differs by (1 + 1/n)(1 + 1/(2 n)): a sum over its hinges in place of the
// integral.
TEST(Bend, SinksLikeACantilever) {
  for (const int n : {2, 4}) {
    EXPECT_NEAR(sag(n), (1 + 1.0 / n) * (1 + 0.5 / n), 2e-3) << n;
  }
}

TEST(Bend, DamperTurnsThePointsByTheCurvatureTimesItsForce) {
  Bodies bodies;
  for (int i = 0; i < 3; ++i) add(bodies, {1, Vec3::Zero(), at(Vec3(i, i == 1 ? 0.3 : 0, 0))});
  bodies.start[2].x.z() += 0.1;
  const Bodies before = bodies;
  const auto lambda = iterate(Bend{{0, 1, 2}, 0, 5}, bodies, 1);
  const Vec3 curvature = before.pose[0].x - 2 * before.pose[1].x + before.pose[2].x;
  EXPECT_LT((given(before, bodies).angular - curvature.cross(lambda.total)).norm(), 1e-14);
  EXPECT_GT(given(before, bodies).angular.norm(), 1e-4);
}

}  // namespace
}  // namespace physics::testing
