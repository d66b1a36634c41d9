// Equations of sections 3 to 5 against dense matrices: the linear system and its sweeps,
// regularisation, the resistance of a pair of bodies.
#include <gtest/gtest.h>

#include "physics/constraints/axle.h"
#include "physics/constraints/ball_socket.h"
#include "physics/world.h"
#include "tests/physics/dense.h"

namespace physics::testing {
namespace {

// Three boxes and two rods that do not fit them: from body 1 to 2 and from 2 to 3.
struct Rods {
  World world;
  std::vector<Distance> items;
  std::vector<Pose> before;

  Rods(Method method, int iterations) : world(settingsOf(method, iterations)) {
    Random random(50);
    for (int b = 0; b < 3; ++b) {
      BodyDef def;
      def.shape = Box{Vec3(0.4, 0.5, 0.7)};
      def.mass = 1 + b;
      def.pose = {Vec3(1.2 * b, 0.1, 0) + random.inBall(0.2), random.rotation(kPi)};
      world.add(def);
    }
    for (int b = 1; b < 3; ++b) {
      DistanceDef def;
      def.bodies = {b, b + 1};
      def.anchors = {random.inBall(0.4), random.inBall(0.4)};
      def.length = 0.5;
      world.add(def);
      items.push_back({def.bodies, def.anchors, 0.5});
    }
    before.assign(world.bodies().pose.begin() + 1, world.bodies().pose.end());
  }

  static Settings settingsOf(Method method, int iterations) {
    Settings settings;
    settings.substeps = 1;
    settings.iterations = iterations;
    settings.method = method;
    return settings;
  }
  Dense dense() const { return denseOf<Distance>(items, world.bodies(), 1); }
  Eigen::VectorXd moved() {  // by one step; they are at rest, so that X^{t+1} = X^t
    world.step();
    return displacement(before, std::span(world.bodies().pose).subspan(1));
  }
};

// k sweeps over A lambda = -c in place, above (49); `jacobi`: with lambda^k for all others, as the
// last of its lines prints.
Eigen::VectorXd sweptByHand(const Dense& d, int count, bool jacobi) {
  const Eigen::MatrixXd a = d.a();
  Eigen::VectorXd lambda = Eigen::VectorXd::Zero(d.c.size());
  for (int k = 0; k < count; ++k) {
    const Eigen::VectorXd old = lambda;
    for (Eigen::Index i = 0; i < lambda.size(); ++i) {
      const Eigen::VectorXd& others = jacobi ? old : lambda;
      lambda[i] = (-d.c[i] - a.row(i).dot(others) + a(i, i) * others[i]) / a(i, i);
    }
  }
  return d.inverseMass * d.j.transpose() * lambda;  // (48)
}

TEST(Equation51, TheLinearMethodIsGaussSeidelInPlaceOnTheDenseSystem) {
  for (const int count : {1, 2, 3, 10}) {
    Rods rods(Method::kLinearGaussSeidel, count);
    const Dense dense = rods.dense();
    EXPECT_LT((rods.moved() - sweptByHand(dense, count, false)).norm(), 1e-14) << count;
  }
}

TEST(Erratum49, EarlierMultipliersAreThoseOfThisSweep) {
  Rods rods(Method::kLinearGaussSeidel, 2);
  const Dense dense = rods.dense();
  const Eigen::VectorXd ours = rods.moved();
  EXPECT_GT((ours - sweptByHand(dense, 2, true)).norm(), 1e-3);
  EXPECT_LT((ours - sweptByHand(dense, 2, false)).norm(), 1e-14);
}

// (40) whole: [M -J^T; J 0] (dX, lambda h^2) = (0, -c).
Eigen::VectorXd solveWhole(const Dense& d) {
  const Eigen::Index n = d.mass.rows(), m = d.c.size();
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + m, n + m);
  whole.topLeftCorner(n, n) = d.mass;
  whole.topRightCorner(n, m) = -d.j.transpose();
  whole.bottomLeftCorner(m, n) = d.j;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + m);
  right.tail(m) = -d.c;
  return whole.fullPivLu().solve(right).head(n);
}

TEST(Equation42, IsTheSolutionOfTheWholeSystemAndWhereTheSweepsEnd) {
  Rods rods(Method::kLinearGaussSeidel, 200);
  const Dense dense = rods.dense();
  const Eigen::VectorXd whole = solveWhole(dense);
  const Eigen::VectorXd lambda = -dense.a().inverse() * dense.c;  // (41),(47)
  EXPECT_LT((dense.inverseMass * dense.j.transpose() * lambda - whole).norm(), 1e-13);
  EXPECT_LT((rods.moved() - whole).norm(), 1e-13);
}

// Balls between points: c is linear, and one Newton step is (42).
TEST(Equation42, IsWhatTheDirectMethodGivesWhereConstraintsAreLinear) {
  World world(Rods::settingsOf(Method::kDirect, 2));
  std::vector<BallSocket> items;
  Random random(51);
  for (int b = 1; b <= 5; ++b) {
    BodyDef def;
    def.mass = 0.5 * b;
    def.pose.x = random.inBall(1);
    world.add(def);
    if (b == 1) continue;
    BallSocketDef joint;
    joint.bodies = {b - 1, b};
    joint.anchors = {{Vec3(0.3, 0, 0), Vec3(0, 0.1, 0)}};
    world.add(joint);
    items.push_back({joint.bodies, *joint.anchors});
  }
  const std::vector<Pose> before(world.bodies().pose.begin() + 1, world.bodies().pose.end());
  const Eigen::VectorXd whole = solveWhole(denseOf<BallSocket>(items, world.bodies(), 1));
  world.step();
  const auto after = std::span(world.bodies().pose).subspan(1);
  EXPECT_LT((displacement(before, after) - whole).norm(), 1e-11);  // alpha is 1e-12 A
}

// (38),(39): what J leaves out is of second order.
TEST(Equation38, TheExpansionOfAnErrorIsOffBySecondOrder) {
  Random random(52);
  const Bodies bodies = randomPair(random);
  const BallSocket item{{0, 1}, {Vec3(0.3, 0.4, 0), Vec3(0, 0.2, -0.5)}};
  const Vec3 dx = random.inBall(1), turn = random.inBall(1);
  const auto row = rowOf(item, bodies);
  const auto left = [&](double h) {
    Bodies moved = bodies;
    displace(moved.pose[0], h * dx, h * turn);
    return (rowOf(item, moved).c - row.c - h * (row.linear[0] * dx + row.angular[0] * turn)).norm();
  };
  EXPECT_NEAR(left(2e-3) / left(1e-3), 4, 0.02);
}

// (55),(56): three balls in a loop that does not close, alpha = .3 of each one's A.
TEST(Equation56, IsStationaryAndTheLeastOfTheRegularisedLagrangian) {
  Bodies bodies;
  const std::vector<BallSocket> items = {
      {{0, 1}}, {{1, 2}}, {{2, 0}, {Vec3(1, 0, 0), Vec3::Zero()}}};
  for (const double m : {1.0, 2.0, 4.0}) add(bodies, {m, Vec3::Zero(), at(Vec3(m, 0.3, 0))});
  const Dense dense = denseOf<BallSocket>(items, bodies);
  const std::vector<Pose> before = bodies.pose;
  std::array<Multipliers<BallSocket>, 3> lambda;
  Scratch<BallSocket> scratch;
  for (int sweep = 0; sweep < 300; ++sweep) {
    for (int k = 0; k < 3; ++k) solve(items[k], lambda[k], {1, 0.3}, bodies, 1, scratch);
  }
  const Eigen::VectorXd dx = displacement(before, bodies.pose), c = dense.c + dense.j * dx;
  Eigen::VectorXd total(9), alpha(9);
  for (int k = 0; k < 3; ++k) {
    total.segment<3>(3 * k) = lambda[k].total;
    alpha.segment<3>(3 * k).setConstant(0.3 * dense.a()(3 * k, 3 * k));
  }
  EXPECT_LT((dense.mass * dx - dense.j.transpose() * total).norm(), 1e-13);
  EXPECT_LT((c + alpha.cwiseProduct(total)).norm(), 1e-13);
  const auto lagrangian = [&](const Eigen::VectorXd& x) {  // at the lambda that is stationary
    const Eigen::VectorXd error = dense.c + dense.j * x;
    return 0.5 * x.dot(dense.mass * x) + 0.5 * error.dot(error.cwiseQuotient(alpha));
  };
  for (int k = 0; k < 18; ++k) {
    if (k % 6 > 2) continue;  // points
    const Eigen::VectorXd d = 0.01 * Eigen::VectorXd::Unit(18, k);
    EXPECT_GT(std::min(lagrangian(dx + d), lagrangian(dx - d)), lagrangian(dx));
  }
}

}  // namespace
}  // namespace physics::testing
