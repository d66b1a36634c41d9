// Equations of sections 2 and 3 that no constraint states by itself: rotations, inertia, free
// motion and the action. Each against differences, a closed form, or a dense matrix.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "physics/world/measure.h"
#include "tests/physics/pair.h"
#include "tests/physics/points.h"

namespace physics::testing {
namespace {

const Vec3 kInertia(1, 2, 2.5);

// (4),(5),(18): d(q r0 q̄)/dt = omega x r.
TEST(Equation5, APointOfABodyMovesByOmegaTimesItsLever) {
  Random random(40);
  for (int n = 0; n < 100; ++n) {
    Pose ahead{random.inBall(1), random.rotation(kPi)}, behind = ahead;
    const Vec3 r0 = random.inBall(1), w = random.inBall(2), r = ahead.q * r0;
    displace(ahead, Vec3::Zero(), 1e-5 * w);
    displace(behind, Vec3::Zero(), -1e-5 * w);
    const Vec3 rate = (ahead.q * r0 - behind.q * r0) / 2e-5;
    EXPECT_LT((rate - w.cross(r)).norm() + (rate - skew(w) * r).norm(), 2e-9);
  }
}

TEST(Equation7, LaterTurnsStandOnTheLeft) {
  Pose pose;
  const Vec3 first(0.3, 0, 0), second(0, 0.4, 0);
  displace(pose, Vec3::Zero(), first);
  displace(pose, Vec3::Zero(), second);
  EXPECT_LT(pose.q.angularDistance(exponential(second) * exponential(first)), 1e-15);
  EXPECT_GT(pose.q.angularDistance(exponential(first + second)), 0.05);  // (6): they do not commute
}

double orientationError(int steps) {  // after 1 s of a torque across the spin, I = 1
  const auto orientation = [](int count) {
    Bodies bodies = bodiesOf({{}});
    bodies.velocity[0].w = Vec3(1, 0, 0);
    const Load load{Vec3::Zero(), Vec3(0, 2, 0)};
    for (int k = 0; k < count; ++k) moveFreely(bodies, {&load, 1}, {}, 1.0 / count);
    return bodies.pose[0].q;
  };
  static const Quat exact = orientation(1 << 16);
  return orientation(steps).angularDistance(exact);
}

TEST(Equation8, ThePathOfTurnsWithTheEndVelocityConvergesWithOrderOne) {
  EXPECT_NEAR(orientationError(64) / orientationError(128), 2, 0.05);
}

TEST(Equation8, AStepTurnsByItsEndVelocity) {
  Bodies bodies = bodiesOf({{}});
  const Load load{Vec3::Zero(), Vec3(0, 2, 0)};
  moveFreely(bodies, {&load, 1}, {}, 0.25);  // the start velocity is 0
  EXPECT_LT((logarithm(bodies.pose[0].q) - Vec3(0, 0.125, 0)).norm(), 1e-15);
}

// (9),(13),(14): energy and momenta are those of the stacked coordinates and one block matrix.
TEST(Equation13, EnergyIsThatOfTheBlockDiagonalMassMatrix) {
  Random random(41);
  World world;
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(18, 18);
  Eigen::VectorXd rate(18);
  for (int b = 0; b < 3; ++b) {
    BodyDef def;
    def.shape = Box{Vec3(0.4, 0.5, 0.7)};
    def.mass = random.uniform(1, 3);
    def.inertia = kInertia;
    def.pose = {random.inBall(1), random.rotation(kPi)};
    def.velocity = {random.inBall(2), random.inBall(2)};
    world.add(def);
    const Mat3 r = def.pose.q.toRotationMatrix();
    mass.block<3, 3>(6 * b, 6 * b) = def.mass * Mat3::Identity();
    mass.block<3, 3>(6 * b + 3, 6 * b + 3) = r * kInertia.asDiagonal() * r.transpose();
    rate.segment<3>(6 * b) = def.velocity.v;
    rate.segment<3>(6 * b + 3) = def.velocity.w;
  }
  EXPECT_NEAR(measure(world).kinetic, 0.5 * rate.dot(mass * rate), 1e-13);
}

struct Top {
  Bodies bodies = bodiesOf({{1, kInertia, {Vec3::Zero(), about({1, 2, 3}, 0.7)}}});
  Vec3 w = Vec3(0.3, 4, -2), torque = Vec3(1, -0.5, 2);
  Top() { bodies.velocity[0].w = w; }
  Mat3 inertia() {
    refreshInertia(bodies);
    return bodies.inverse[0].inertia.inverse();
  }
  void step(double dt) {
    const Load load{Vec3::Zero(), torque};
    moveFreely(bodies, {&load, 1}, {}, dt);
  }
};

// (16),(27),(30): I w' = tau + (I w) x w, in the limit of a small step.
TEST(Equation16, FreeMotionBeginsWithEulersEquation) {
  Top top;
  const Mat3 inertia = top.inertia();
  const Vec3 gyroscopic = (inertia * top.w).cross(top.w);
  top.step(1e-7);
  const Vec3 rate = (top.bodies.velocity[0].w - top.w) / 1e-7;
  EXPECT_LT((inertia * rate - top.torque - gyroscopic).norm(), 1e-4);  // O(h)
  EXPECT_GT((inertia * rate - top.torque + gyroscopic).norm(), 10);    // the other sign
}

Mat3 inertiaAfter(double time) {
  Top top;
  displace(top.bodies.pose[0], Vec3::Zero(), time * top.w);
  return top.inertia();
}

TEST(Equation17, TheInertiaOfATurningBodyChangesByItsCommutatorWithTheSpin) {
  const Top top;
  const Mat3 inertia = inertiaAfter(0), spin = skew(top.w);
  const Mat3 rate = (inertiaAfter(1e-5) - inertiaAfter(-1e-5)) / 2e-5;
  EXPECT_LT((rate - (spin * inertia - inertia * spin)).norm(), 1e-6);
  EXPECT_GT((rate + (spin * inertia - inertia * spin)).norm(), 1);
}

TEST(Equation26, TheExpansionOfTheInertiaIsOffBySecondOrder) {
  const auto left = [](double h) {
    const Mat3 inertia = inertiaAfter(0), turn = skew(h * Top().w);
    return (inertiaAfter(h) - (inertia + turn * inertia - inertia * turn)).norm();
  };
  EXPECT_NEAR(left(2e-3) / left(1e-3), 4, 0.05);
}

// I(q') w' - I(q) w = h tau. The explicit (30) leaves a residual, the other sign a larger one.
TEST(Equation25, HoldsForATopUnderATorqueToRounding) {
  Top top;
  const Mat3 inertia = top.inertia();
  const Vec3 before = inertia * top.w, gyroscopic = before.cross(top.w);
  top.step(kStep);
  const Vec3 after = top.inertia() * top.bodies.velocity[0].w;
  EXPECT_LT((after - before - kStep * top.torque).norm(), 1e-13);
  for (const double sign : {1.0, -1.0}) {  // (30),(31), and with the sign turned
    Top printed;
    const Vec3 w = top.w + kStep * inertia.inverse() * (top.torque + sign * gyroscopic);
    displace(printed.bodies.pose[0], Vec3::Zero(), kStep * w);
    const double residual = (printed.inertia() * w - before - kStep * top.torque).norm();
    EXPECT_GT(residual, sign > 0 ? 1e-4 : 0.1);
  }
}

// (32),(43),(44); (45) to first order in the turn of the step, .075 here.
TEST(Equation32, ADisplacementChangesTheVelocityByItselfOverTheStep) {
  Top top;
  top.bodies.velocity[0].v = Vec3(1, 2, 3);
  top.step(kStep);
  const Velocity before = top.bodies.velocity[0];
  const Vec3 dx(0.01, -0.02, 0.03), turn(1e-4, -3e-4, 2e-4);
  top.bodies.shift[0] += dx;
  displace(top.bodies.pose[0], dx, turn);
  finishVelocities(top.bodies, kStep);
  const Velocity& after = top.bodies.velocity[0];
  EXPECT_LT((after.v - before.v - dx / kStep).norm(), 1e-13);
  EXPECT_LT((after.v - (top.bodies.pose[0].x - top.bodies.start[0].x) / kStep).norm(), 1e-13);
  EXPECT_LT((after.w - before.w - turn / kStep).norm(), 0.05 * turn.norm() / kStep);
}

// Momentum times h after a displacement d: h M(X + d)(Xdot + d/h), (33).
Vec3 displacedMomentum(const Vec3& d) {
  Top top;
  displace(top.bodies.pose[0], Vec3::Zero(), d);
  return kStep * (top.inertia() * (top.w + d / kStep));
}

TEST(Equation36, TheChangeOfMomentumUnderADisplacementIsItsInertia) {
  Top top;
  const Mat3 inertia = top.inertia();
  const Vec3 turn = kStep * top.w;
  const Mat3 extra = inertia * skew(turn) - skew(inertia * turn);
  Mat3 slope;
  for (int k = 0; k < 3; ++k) {
    const Vec3 d = 1e-5 * Vec3::Unit(k);
    slope.col(k) = (displacedMomentum(d) - displacedMomentum(-d)) / 2e-5;
  }
  EXPECT_LT((slope - (inertia + extra)).norm(), 1e-8);  // (35),(36),(65)
  EXPECT_GT((slope - (inertia - extra)).norm(), 0.1);
}

// The velocity rule here is the logarithm, which halves the second term (options_test.cpp has the
// differences); linear motion has no extra term, (34).
TEST(Equation36, OursHasHalfTheSecondTermAndTheLinearPartNone) {
  Top top;
  const Mat3 inertia = top.inertia();
  const Vec3 turn = kStep * top.w;
  refreshSpinInertia(top.bodies, kStep);
  const Mat3 expected = inertia - skew(inertia * turn) + 0.5 * inertia * skew(turn);
  EXPECT_LT((top.bodies.inverse[0].inertia.inverse() - expected).norm(), 1e-13);
  EXPECT_EQ(top.bodies.inverse[0].m, 1);
}

}  // namespace
}  // namespace physics::testing
