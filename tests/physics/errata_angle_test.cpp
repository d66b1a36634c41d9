// Misprints of the paper's angular constraints and drives, sections 6 and 9.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/constraints/axle.h"
#include "physics/constraints/cone_limit.h"
#include "physics/constraints/drive.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

Bodies apart(double angle) {  // x axes an angle apart, equal isotropic bodies
  const BodyOf ball{1, Vec3::Constant(0.1), {}};
  Bodies bodies = bodiesOf({ball, ball});
  bodies.pose[1].q = bodies.start[1].q = about({0, 0, 1}, angle);
  return bodies;
}
Vec3 x(const Bodies& bodies, int b) { return bodies.pose[b].q * Vec3::UnitX(); }
double angleInDegrees(const Bodies& bodies) {
  return angleOf(x(bodies, 0), x(bodies, 1)) / kDegree;
}
const ConeLimit kAlong{{0, 1}, {Vec3::UnitX(), Vec3::UnitX()}, 0};  // c = phi

// One iteration of (85) as printed, (86) for phi.
void printed85(Bodies& bodies) {
  const Vec3 cross = x(bodies, 0).cross(x(bodies, 1)), w = cross.normalized();
  const double mu = 0.05, phi = std::asin(std::min(cross.norm(), 1.0));
  const Vec3 kappa = -mu * w * phi;
  displace(bodies.pose[0], Vec3::Zero(), kappa / 0.1);
  displace(bodies.pose[1], Vec3::Zero(), -kappa / 0.1);
}

TEST(Erratum85, AsPrintedTheAxleOpens) {
  Bodies printed = apart(40 * kDegree);
  for (const double expected : {80.0, 160.0, 180.0}) {
    printed85(printed);
    EXPECT_NEAR(angleInDegrees(printed), expected, 1e-6);
  }
  Bodies ours = apart(40 * kDegree);
  Mat3 frame;
  frame << Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX();
  iterate(Axle{{0, 1}, Vec3::UnitX(), frame}, ours, 1);
  EXPECT_LT(angleInDegrees(ours), 1e-10);
}

TEST(Erratum81, TheGradientOfTheAngleIsMinusWForTheFirstBody) {
  const Bodies bodies = apart(40 * kDegree);
  const Vec3 w = x(bodies, 0).cross(x(bodies, 1)).normalized();
  Bodies turned = bodies;
  displace(turned.pose[0], Vec3::Zero(), 1e-4 * w);
  const double difference = (angleInDegrees(turned) - angleInDegrees(bodies)) * kDegree / 1e-4;
  EXPECT_NEAR(difference, -1, 1e-9);  // printed: +1
  EXPECT_NEAR(rowOf(kAlong, bodies).angular[0].dot(w.transpose()), -1, 1e-12);
  EXPECT_NEAR(rowOf(kAlong, bodies).angular[1].dot(w.transpose()), 1, 1e-12);
}

TEST(Erratum80, AnArcSineReadsHundredAndTwentyDegreesAsSixty) {
  const Bodies bodies = apart(120 * kDegree);
  EXPECT_NEAR(std::asin(x(bodies, 0).cross(x(bodies, 1)).norm()) / kDegree, 60, 1e-9);
  EXPECT_NEAR(rowOf(kAlong, bodies).c[0] / kDegree, 120, 1e-12);
}

TEST(Erratum80, AnArcSineFallsWhereTheAngleGrowsPastNinety) {
  const auto printed = [](double degrees) { return std::asin(std::sin(degrees * kDegree)); };
  EXPECT_LT(printed(121), printed(120));
  EXPECT_GT(rowOf(kAlong, apart(121 * kDegree)).c[0], rowOf(kAlong, apart(120 * kDegree)).c[0]);
}

TEST(Erratum80, AnArcSineInSinglePrecisionHasNoDigitsBesideNinety) {
  const float sine = static_cast<float>(std::sin(89.99 * kDegree));
  EXPECT_NEAR(std::asin(sine) / kDegree, 90, 1e-5);
  EXPECT_NEAR(rowOf(kAlong, apart(89.99 * kDegree)).c[0] / kDegree, 89.99, 1e-12);
}

// (88) prints w_i x w_i, which is nothing whatever the bodies do.
TEST(Erratum88, TheConeMeasuresItsAxesNotTheAxisBetweenThem) {
  const Bodies bodies = apart(50 * kDegree);
  const Vec3 w = x(bodies, 0).cross(x(bodies, 1)).normalized();
  const double limit = 30 * kDegree;
  EXPECT_EQ(std::asin(w.cross(w).norm()) - limit, -limit);  // never violated
  const ConeLimit ours{{0, 1}, {Vec3::UnitX(), Vec3::UnitX()}, limit};
  EXPECT_NEAR(rowOf(ours, bodies).c[0], 20 * kDegree, 1e-12);
}

// A drive's update in one dimension, with I = 1 and the sign of delta theta as given.
double driven(double sign, double k, double nu, int steps) {
  const double h = 1.0 / 60, alpha = k * h * h + nu * h;
  double theta = 1, omega = 0;  // of body i past its target
  for (int step = 0; step < steps; ++step) {
    const double free = theta + h * omega;
    const double kappa = -(k * h * h * sign * free + nu * h * (free - theta)) / (1 + alpha);
    omega = (free + kappa - theta) / h;
    theta += h * omega;
  }
  return theta;
}

TEST(Erratum129, WithWiCrossWjTheDriveRunsAway) {
  EXPECT_GT(driven(-1, 2, 0.2, 60), 2.1);
  EXPECT_LT(std::abs(driven(1, 2, 0.2, 60)), 1);
}

TEST(Erratum129, OursTurnsTowardsTheTarget) {
  Bodies bodies = apart(1);
  iterate(Drive{{0, 1}, Quat::Identity(), 20, 0}, bodies, 1);
  EXPECT_LT(angleInDegrees(bodies) * kDegree, 1);
  EXPECT_NEAR(x(bodies, 1).y(), std::sin(logarithm(bodies.pose[1].q).z()), 1e-12);
}

// One step of (130) for a body with I = .0111; two iterations.
double after130(double theta, double& omega, bool printed) {
  const double k = 2000, nu = 5, h = 1.0 / 60, a = 1 / 0.0111, alpha = k * h * h + nu * h;
  double now = theta + h * omega, kappa = 0;
  for (int iteration = 0; iteration < 2; ++iteration) {
    const double pull = k * h * h * now + nu * h * (now - theta);
    const double next = (alpha * a * kappa - pull) / (1 + alpha * a);
    now += a * (printed ? next : next - kappa);
    kappa = next;
  }
  omega = (now - theta) / h;
  return now;
}

TEST(Erratum130, TheChangeOfKappaIsAppliedNotKappa) {
  double printed = 1, printedSpeed = 0, corrected = 1, correctedSpeed = 0;
  for (int step = 0; step < 60; ++step) {
    printed = after130(printed, printedSpeed, true);
    corrected = after130(corrected, correctedSpeed, false);
  }
  EXPECT_GT(std::abs(printed), 0.99);
  EXPECT_LT(std::abs(corrected), 1e-12);
}

TEST(Erratum130, OursDoesNotDependOnTheNumberOfIterations) {
  const BodyOf ball{1, Vec3::Constant(0.0111), {}};
  Bodies once = bodiesOf({{0, Vec3::Zero(), {}}, ball}), often = once;
  once.pose[1].q = often.pose[1].q = about({0, 0, 1}, 1);
  const Drive drive{{0, 1}, Quat::Identity(), 2000, 5};
  iterate(drive, once, 1);
  iterate(drive, often, 8);
  EXPECT_LT(once.pose[1].q.angularDistance(often.pose[1].q), 1e-14);
}

TEST(Erratum132, AComponentwiseMinimumLetsTheTorqueThroughItsLimit) {
  const double h = 1.0 / 60, most = h * h;  // tau_max = 1
  for (const double error : {1.2, -1.2}) {
    Bodies bodies = apart(0);
    bodies.pose[1].q = bodies.start[1].q = exponential(error * Vec3(1, 1, 1).normalized());
    const auto free = iterate(Drive{{0, 1}, Quat::Identity(), 200, 0}, bodies, 1, h);
    const Vec3 printed = free.total.cwiseMin(most);
    EXPECT_GT(printed.norm() / most, error < 0 ? 1.7 : 40);
    bodies.pose = bodies.start;
    const auto ours = iterate(Drive{{0, 1}, Quat::Identity(), 200, 0, 1}, bodies, 1, h);
    EXPECT_NEAR(ours.total.norm() / most, 1, 1e-12);
    EXPECT_LT(angleOf(ours.total, free.total), 1e-12);
  }
}

}  // namespace
}  // namespace physics::testing
