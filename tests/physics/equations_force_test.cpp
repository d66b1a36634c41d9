// Equations of section 8 against dense matrices: the force of a spring, its derivative, and its
// update before and after Woodbury.
#include <gtest/gtest.h>

#include "physics/constraints/ball_socket.h"
#include "physics/constraints/hardening_spring.h"
#include "physics/constraints/spring.h"
#include "tests/physics/dense.h"
#include "tests/physics/points.h"

namespace physics::testing {
namespace {

constexpr double kStiffness = 800, kDamping = 3;
constexpr double kAlpha = kStiffness * kStep * kStep + kDamping * kStep;  // (115)

struct Sprung {
  Bodies bodies;
  VectorSpring item{{0, 1}, {Vec3(0.3, 0.4, 0), Vec3(0, 0.2, -0.5)}, kStiffness, kDamping};
  explicit Sprung(std::uint64_t seed) {
    Random random(seed);
    bodies = randomPair(random);
    for (Pose& pose : bodies.start) displace(pose, random.inBall(0.1), random.inBall(0.3));
  }
  Vec3 arm(int b) const { return bodies.pose[b].q * item.anchors[b]; }
  Vec3 gap(const std::vector<Pose>& pose) const {
    return pose[0].x + pose[0].q * item.anchors[0] - pose[1].x - pose[1].q * item.anchors[1];
  }
  Vec3 force() const {  // (108) times h^2
    const Vec3 now = gap(bodies.pose), rate = (now - gap(bodies.start)) / kStep;
    return kStep * kStep * (-kStiffness * now - kDamping * rate);
  }
  Eigen::MatrixXd q() const {  // (112)
    Eigen::MatrixXd q(12, 3);
    q << Mat3::Identity(), skew(arm(0)), -Mat3::Identity(), -skew(arm(1));
    return q;
  }
  Dense dense() const {  // masses alone
    const std::array<BallSocket, 0> none{};
    return denseOf<BallSocket>(none, bodies);
  }
  Eigen::VectorXd load() const {  // F of (110), times h^2
    const Vec3 f = force();
    Eigen::VectorXd load(12);
    load << f, arm(0).cross(f), -f, -arm(1).cross(f);
    return load;
  }
};

TEST(Equation108, TheForceAndItsTorquesAreThoseOfTheSpring) {  // (108)-(112)
  for (std::uint64_t seed = 70; seed < 80; ++seed) {
    const Sprung spring(seed);
    const auto push = rowOf(spring.item, spring.bodies, kStep);
    EXPECT_LT((push.f - spring.force()).norm(), 1e-14);
    Eigen::VectorXd load(12);
    for (int b = 0; b < 2; ++b) {
      load.segment<3>(6 * b) = push.linear[b].transpose() * push.f;
      load.segment<3>(6 * b + 3) = push.angular[b].transpose() * push.f;
    }
    EXPECT_LT((load - spring.load()).norm(), 1e-14);
    EXPECT_LT((load - spring.q() * push.f).norm(), 1e-14);
  }
}

// Column k: the derivative of `of` by coordinate k of both bodies.
template <class F>
Eigen::MatrixXd derivativeOf(const Sprung& spring, F of) {
  constexpr double kSmall = 1e-5;
  Eigen::MatrixXd slope(of(spring).size(), 12);
  for (int k = 0; k < 12; ++k) {
    Vec3 dx = Vec3::Zero(), turn = Vec3::Zero();
    (k % 6 < 3 ? dx : turn)[k % 3] = kSmall;
    Sprung ahead = spring, behind = spring;
    displace(ahead.bodies.pose[k / 6], dx, turn);
    displace(behind.bodies.pose[k / 6], -dx, -turn);
    slope.col(k) = (of(ahead) - of(behind)) / (2 * kSmall);
  }
  return slope;
}

TEST(Equation113, TheForceFallsOffByAlphaAlongQ) {
  const Sprung spring(71);
  const auto slope = derivativeOf(spring, [](const Sprung& s) { return s.force(); });
  EXPECT_LT((slope + kAlpha * spring.q().transpose()).norm(), 1e-9);
  const auto push = rowOf(spring.item, spring.bodies, kStep);
  EXPECT_LT((push.k - kAlpha * Mat3::Identity()).norm(), 1e-15);  // (104),(115)
}

// (114) leaves out how the levers turn, [f]x[r]x. That costs iterations, not the end of them.
TEST(Equation114, IsTheDerivativeButForTheTurnOfTheLevers) {
  const Sprung spring(72);
  const auto slope = derivativeOf(spring, [](const Sprung& s) { return s.load(); });
  const Eigen::MatrixXd written = -kAlpha * spring.q() * spring.q().transpose();
  Eigen::MatrixXd levers = Eigen::MatrixXd::Zero(12, 12);
  levers.block<3, 3>(3, 3) = skew(spring.force()) * skew(spring.arm(0));
  levers.block<3, 3>(9, 9) = -skew(spring.force()) * skew(spring.arm(1));
  EXPECT_LT((slope - written - levers).norm(), 1e-8);
  EXPECT_GT((slope - written).norm(), 0.01);
}

TEST(Equation119, WoodburysIdentityHolds) {
  Random random(73);
  const auto matrix = [&](int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.uniform(-1, 1); })
        .eval();
  };
  const Eigen::MatrixXd a = matrix(6, 6) + 6 * Eigen::MatrixXd::Identity(6, 6), u = matrix(6, 2),
                        v = matrix(2, 6), inverse = a.inverse();
  const Eigen::MatrixXd small = Eigen::MatrixXd::Identity(2, 2) + v * inverse * u;
  const Eigen::MatrixXd b = inverse - inverse * u * small.inverse() * v * inverse;
  EXPECT_LT((b * (a + u * v) - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-13);
}

TEST(Equation120, TheInverseOfTwelveRowsIsOneOfThree) {
  const Sprung spring(74);
  const Dense dense = spring.dense();
  const Eigen::MatrixXd q = spring.q();
  const Mat3 a = q.transpose() * dense.inverseMass * q;  // (121)
  const Eigen::MatrixXd left = dense.mass * (dense.mass + kAlpha * q * q.transpose()).inverse() * q;
  const Mat3 small = (Mat3::Identity() + kAlpha * a).inverse();
  EXPECT_LT((left - (q - q * small * kAlpha * a)).norm(), 1e-12);
  EXPECT_LT((left - q * small).norm(), 1e-12);
}

// The first update of a force from rest, (M + K h^2) dX = F h^2 in 12 rows:
// (103),(105),(106),(116).
template <class C>
void expectDenseUpdate(const C& item, Bodies bodies) {
  const std::array<C, 0> none{};
  const Eigen::MatrixXd mass = denseOf<C>(none, bodies).mass;
  const Eigen::MatrixXd j = denseOf<C>({&item, 1}, bodies).j;
  const auto push = rowOf(item, bodies, kStep);
  const Eigen::VectorXd expected =
      (mass + j.transpose() * push.k * j).inverse() * (j.transpose() * push.f);
  const std::vector<Pose> before = bodies.pose;
  Multipliers<C> lambda;
  visit(item, lambda, bodies, kStep);
  const Eigen::VectorXd dx = displacement(before, bodies.pose);
  EXPECT_LT((dx - expected).norm(), 1e-12);
  EXPECT_LT((mass * dx - j.transpose() * lambda.total).norm(), 1e-12);  // (117)
}

TEST(Equation116, IsTheUpdateOfAVisit) {
  const Sprung spring(75);
  expectDenseUpdate(spring.item, spring.bodies);
  expectDenseUpdate(HardeningSpring{{0, 1}, spring.item.anchors, 300, 400, 2, 0.7}, spring.bodies);
}

// (122)-(124) with the relaxation xi, from a total lambda.
Vec3 update124(const Sprung& spring, const Vec3& lambda, double xi) {
  const Eigen::MatrixXd q = spring.q();
  const Mat3 a = q.transpose() * spring.dense().inverseMass * q;
  const Mat3 left = (Mat3::Identity() + kAlpha * a).inverse();
  return (1 - xi) * lambda + xi * (left * (kAlpha * (a * lambda) + spring.force()));
}

TEST(Equation124, IsEveryIterateWhateverTheRelaxation) {
  for (const double xi : {0.3, 1.0, 1.5}) {
    Sprung spring(76);
    Multipliers<VectorSpring> lambda;
    Scratch<VectorSpring> scratch;
    for (int k = 0; k < 5; ++k) {
      refreshInertia(spring.bodies);
      const Vec3 expected = update124(spring, lambda.total, xi);
      solve(spring.item, lambda, {xi, 0}, spring.bodies, kStep, scratch);
      EXPECT_LT((lambda.total - expected).norm(), 1e-13) << xi << " iterate " << k;
    }
  }
}

// "we have also included xi in (122)": it is in (124).
TEST(Erratum122, HasNoRelaxationInIt) {
  Sprung spring(77);
  Multipliers<VectorSpring> lambda;
  Scratch<VectorSpring> scratch;
  const Vec3 printed = update124(spring, Vec3::Zero(), 1);
  solve(spring.item, lambda, {0.3, 0}, spring.bodies, kStep, scratch);
  EXPECT_LT((lambda.total - 0.3 * printed).norm(), 1e-14);
}

}  // namespace
}  // namespace physics::testing
