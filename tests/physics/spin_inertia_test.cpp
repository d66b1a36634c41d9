// The inertia M~ of a spinning body, (36),(65), and its guard.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "physics/world.h"
#include "tests/physics/pair.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {
namespace {

Bodies spinningBox(double turn) {
  const Vec3 size(1, 2, 3), squares = size.cwiseAbs2();
  Bodies bodies = bodiesOf(
      {{1, (Vec3::Constant(squares.sum()) - squares) / 12, {Vec3::Zero(), about({1, 2, 3}, 0.7)}}});
  bodies.velocity[0].w = Vec3(1, -2, 0.5).normalized() * turn * 60;
  return bodies;
}

// (65) with half the second term: what the displacement -> velocity rule by the logarithm asks for.
TEST(SpinInertia, GivesTheChangeOfAngularMomentumToSecondOrder) {
  constexpr double kDt = 1.0 / 60;
  Bodies bodies = spinningBox(0.15);
  const Vec3 w = bodies.velocity[0].w, small = 1e-6 * Vec3(0.3, -0.5, 0.8);
  refreshInertia(bodies);
  const auto momentumOf = [&](const Vec3& extra) {  // start, then h w, then the displacement
    const Quat moved = exponential(extra) * exponential(kDt * w) * bodies.start[0].q;
    const Vec3 rate = logarithm(moved * bodies.start[0].q.conjugate()) / kDt;
    const Mat3 r = moved.toRotationMatrix();
    return (r * bodies.inertia[0].asDiagonal() * r.transpose() * rate).eval();
  };
  bodies.pose[0].q = exponential(kDt * w) * bodies.start[0].q;
  const Vec3 change = kDt * (momentumOf(small) - momentumOf(Vec3::Zero()));
  refreshInertia(bodies);
  const Vec3 plain = bodies.inverse[0].inertia.inverse() * small;
  refreshSpinInertia(bodies, kDt);
  const Vec3 spinning = bodies.inverse[0].inertia.inverse() * small;
  EXPECT_GT((plain - change).norm(), 0.03 * change.norm());
  EXPECT_LT((spinning - change).norm(), 0.01 * change.norm());  // second order in 0.15
}

TEST(SpinInertia, StaysPositiveAndStepsAsideForFastSpins) {
  for (const double turn : {0.01, 0.1, 0.19, 0.21, 1.0, 3.0}) {
    Bodies bodies = spinningBox(turn);
    refreshInertia(bodies);
    const Mat3 plain = bodies.inverse[0].inertia;
    refreshSpinInertia(bodies, 1.0 / 60);
    const Mat3 used = bodies.inverse[0].inertia;
    EXPECT_EQ(used == plain, turn > 0.2) << turn;
    const Mat3 symmetric = 0.5 * (used + used.transpose());
    const double least = Eigen::SelfAdjointEigenSolver<Mat3>(symmetric).eigenvalues().minCoeff();
    EXPECT_GT(least, 0.9 / bodies.inertia[0].maxCoeff()) << turn;
  }
}

TEST(SpinInertia, JoinsAFastPairWithLessErrorAfterOneIteration) {
  const auto errorWith = [](bool spin) {
    Settings settings = sweeps();
    settings.substeps = 1;
    settings.spinInertia = spin;
    settings.refreshInertia = false;
    World world(settings);
    BodyDef def;
    def.shape = Box{Vec3(0.2, 1, 0.3)};
    def.velocity.w = Vec3(6, 1, -6);
    BallSocketDef joint;
    joint.bodies[0] = world.add(def);
    def.pose.x = Vec3(0, 1, 0);
    def.velocity.w = Vec3(-4, 2, 6);
    joint.bodies[1] = world.add(def);
    joint.at = Vec3(0, 0.5, 0);
    world.add(joint);
    world.step();
    return world.constraintErrors()[0].largest;
  };
  EXPECT_NE(errorWith(true), errorWith(false));
  EXPECT_LT(errorWith(true), 0.05);
}

}  // namespace
}  // namespace physics::testing
