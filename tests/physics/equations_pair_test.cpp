// Equations of section 5 for one pair of bodies: resistance, impulse and momenta; and their
// misprints, each beside ours.
#include <gtest/gtest.h>

#include "physics/constraints/axle.h"
#include "physics/constraints/ball_socket.h"
#include "tests/physics/dense.h"

namespace physics::testing {
namespace {

struct Pair {
  Bodies bodies;
  BallSocket joint{{0, 1}, {Vec3(0.3, 0.4, 0), Vec3(0, 0.2, -0.5)}};
  explicit Pair(std::uint64_t seed) {
    Random random(seed);
    bodies = randomPair(random);
  }
  Vec3 arm(int b) const { return bodies.pose[b].q * joint.anchors[b]; }
  Vec3 gap() const { return rowOf(joint, bodies).c; }
  Mat3 resistanceOfBoth() const {
    Response<BallSocket> response;
    return effectiveMassInverse(joint, rowOf(joint, bodies), bodies.inverse, response);
  }
  // (64),(73),(94),(121) with the lever of the second body given.
  Mat3 written(const Vec3& rj) const {
    const Mat3 ri = skew(arm(0)), sj = skew(rj);
    return (bodies.inverse[0].m + bodies.inverse[1].m) * Mat3::Identity() -
           ri * bodies.inverse[0].inertia * ri - sj * bodies.inverse[1].inertia * sj;
  }
};

TEST(Equation64, IsJTimesTheInverseMassTimesJTransposed) {
  for (std::uint64_t seed = 60; seed < 80; ++seed) {
    const Pair pair(seed);
    const Mat3 dense = denseOf<BallSocket>({&pair.joint, 1}, pair.bodies).a();
    EXPECT_LT((pair.written(pair.arm(1)) - dense).norm(), 1e-14 * dense.norm());
    EXPECT_LT((pair.resistanceOfBoth() - dense).norm(), 1e-14 * dense.norm());
  }
}

TEST(Erratum121, TheSecondLeverIsThatOfTheSecondBody) {
  const Pair pair(60);
  EXPECT_GT((pair.written(pair.arm(0)) - pair.resistanceOfBoth()).norm(), 0.1);
}

// (63),(67),(68): kappa = -mu dp, mu = 1/(d . A d).
TEST(Equation68, TheScalarImpulseIsTheGapOverItsResistance) {
  Pair pair(61);
  pair.joint.form = Form::kScalar;
  const Vec3 dp = pair.gap(), d = dp.normalized();
  const Mat3 a = pair.resistanceOfBoth();
  Multipliers<BallSocket> kappa;
  visit(pair.joint, kappa, pair.bodies);
  EXPECT_LT((kappa.total + dp / d.dot(a * d)).norm(), 1e-14);
}

TEST(ErratumAfter73, WithoutItsMinusTheImpulseOpensTheGap) {
  Pair pair(62);
  const Vec3 dp = pair.gap(), printed = pair.resistanceOfBoth().inverse() * dp;
  Bodies opened = pair.bodies;
  for (int b = 0; b < 2; ++b) {
    const double sign = b == 0 ? 1 : -1;
    displace(opened.pose[b], sign * opened.inverse[b].m * printed,
             sign * (opened.inverse[b].inertia * pair.arm(b).cross(printed)));
  }
  EXPECT_GT(rowOf(pair.joint, opened).c.norm(), 1.3 * dp.norm());
  Multipliers<BallSocket> kappa;
  visit(pair.joint, kappa, pair.bodies);
  EXPECT_LT((kappa.total + printed).norm(), 1e-13 * printed.norm());
}

// (57): a body's share of the multiplier is its gain of momentum, times h.
TEST(Equation57, JTransposedLambdaIsTheMomentumEachBodyGets) {
  Pair pair(63);
  const auto row = rowOf(pair.joint, pair.bodies);
  const std::vector<Pose> before = pair.bodies.pose;
  const std::array<Mat3, 2> inertia = {inertiaOf(pair.bodies, 0), inertiaOf(pair.bodies, 1)};
  Multipliers<BallSocket> lambda;
  visit(pair.joint, lambda, pair.bodies);
  const Eigen::VectorXd dx = displacement(before, pair.bodies.pose);
  for (int b = 0; b < 2; ++b) {
    const Vec3 push = row.linear[b].transpose() * lambda.total;
    const Vec3 twist = row.angular[b].transpose() * lambda.total;
    EXPECT_LT((pair.bodies.mass[b] * dx.segment<3>(6 * b) - push).norm(), 1e-13);
    EXPECT_LT((inertia[b] * dx.segment<3>(6 * b + 3) - twist).norm(), 1e-13);
  }
}

// (50) prints the inverse mass of body i for body j.
TEST(Erratum50, EachBodyMovesByItsOwnInverseMass) {
  Bodies bodies = bodiesOf({{1, Vec3::Zero(), {}}, {3, Vec3::Zero(), at(Vec3(1, 0, 0))}});
  const Bodies before = bodies;
  const auto lambda = iterate(BallSocket{{0, 1}}, bodies, 1);
  EXPECT_LT(given(before, bodies).linear.norm(), 1e-15);
  EXPECT_LT((bodies.pose[0].x - bodies.pose[1].x).norm(), 1e-15);
  const Vec3 printedGap = Vec3(-1, 0, 0) + (1.0 + 1.0) * lambda.total;  // both by 1/m_0
  EXPECT_GT(printedGap.norm(), 0.4);
}

// (69),(70) print -kappa on i, +kappa on j, and a minus before the second body's orbit.
TEST(Erratum69, TheImpulseIsPlusOnTheFirstBodyAndTheMomentaAddUp) {
  Pair pair(64);
  pair.joint.form = Form::kScalar;
  const Bodies before = pair.bodies;
  Multipliers<BallSocket> kappa;
  visit(pair.joint, kappa, pair.bodies);
  const Eigen::VectorXd dx = displacement(before.pose, pair.bodies.pose);
  EXPECT_LT((before.mass[0] * dx.segment<3>(0) - kappa.total).norm(), 1e-13);  // printed: minus
  EXPECT_LT((before.mass[1] * dx.segment<3>(6) + kappa.total).norm(), 1e-13);
  std::array<Vec3, 2> orbit, spin;
  for (int b = 0; b < 2; ++b) {
    orbit[b] = before.pose[b].x.cross(before.mass[b] * dx.segment<3>(6 * b));
    spin[b] = inertiaOf(before, b) * dx.segment<3>(6 * b + 3);
  }
  EXPECT_LT((orbit[0] + spin[0] + orbit[1] + spin[1]).norm(), 1e-12);
  EXPECT_GT((orbit[0] + spin[0] - orbit[1] + spin[1]).norm(), 0.01);
}

// (67) has M~ in mu and I in the update: with both alike J dX = -c, mixed it is not.
TEST(Erratum67, TheInertiaOfTheUpdateIsThatOfTheResistance) {
  Pair pair(65);
  constexpr double kDt = 1.0 / 60;
  for (Velocity& velocity : pair.bodies.velocity) velocity.w = Vec3(6, -5, 7);
  const std::vector<InverseMass> plain = pair.bodies.inverse;
  refreshSpinInertia(pair.bodies, kDt);
  const Vec3 c = pair.gap();
  const auto row = rowOf(pair.joint, pair.bodies);
  const std::vector<Pose> before = pair.bodies.pose;
  Multipliers<BallSocket> kappa;
  visit(pair.joint, kappa, pair.bodies);
  const Eigen::VectorXd dx = displacement(before, pair.bodies.pose);
  Vec3 ours = c, mixed = c;
  for (int b = 0; b < 2; ++b) {
    const Vec3 push = row.linear[b].transpose() * kappa.total;
    const Vec3 twist = row.angular[b].transpose() * kappa.total;
    ours += row.linear[b] * dx.segment<3>(6 * b) + row.angular[b] * dx.segment<3>(6 * b + 3);
    mixed += plain[b].m * row.linear[b] * push + row.angular[b] * (plain[b].inertia * twist);
  }
  EXPECT_LT(ours.norm(), 1e-13);
  EXPECT_GT(mixed.norm(), 1e-3 * c.norm());
}

// (83): mu of the axle's scalar form is 1/(w . (I_i^-1 + I_j^-1) w).
TEST(Equation83, TheResistanceOfAnAxleIsThatOfBothInertiasAboutItsAxis) {
  Pair pair(66);
  Mat3 frame;
  frame << Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX();
  const Axle axle{{0, 1}, Vec3::UnitX(), frame, Form::kScalar};
  const AngleBetween angle =
      angleBetween(pair.bodies.pose[0].q * Vec3::UnitX(), pair.bodies.pose[1].q * Vec3::UnitX());
  const double mu =
      1 / angle.w.dot((pair.bodies.inverse[0].inertia + pair.bodies.inverse[1].inertia) * angle.w);
  Multipliers<Axle> kappa;
  visit(axle, kappa, pair.bodies);
  EXPECT_NEAR(kappa.total.norm(), mu * angle.phi, 1e-12);  // (87)
}

// (21) says 6N x M; what it shows, and what J dX and J M^-1 J^T need, is M x 6N.
TEST(Erratum21, TheJacobianHasARowForEachConstraint) {
  const Pair pair(67);
  const Dense dense = denseOf<BallSocket>({&pair.joint, 1}, pair.bodies);
  EXPECT_EQ(dense.j.rows(), 3);
  EXPECT_EQ(dense.j.cols(), 6 * 2);
  EXPECT_EQ(rowOf(pair.joint, pair.bodies).linear[0].rows(), BallSocket::kRows);
}

}  // namespace
}  // namespace physics::testing
