// Misprints of the paper's sections 6 to 10 that the other errata files leave: arc sines, clamps,
// anchors and right-hand sides. The printed form beside ours on the smallest example.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/constraints/axle.h"
#include "physics/constraints/cone_limit.h"
#include "physics/constraints/drive.h"
#include "physics/constraints/link.h"
#include "physics/constraints/spring.h"
#include "tests/physics/points.h"
#include "tests/physics/slope.h"

namespace physics::testing {
namespace {

// A body whose x axis is `angle` from that of a body that stands; I = .1.
Bodies turned(double angle) {
  Bodies bodies = bodiesOf({{0, Vec3::Zero(), {}}, {1, Vec3::Constant(0.1), {}}});
  bodies.pose[1].q = bodies.start[1].q = about({0, 0, 1}, angle);
  return bodies;
}
double angleAt(const Bodies& bodies) { return logarithm(bodies.pose[1].q).z() / kDegree; }

// (80),(86) print n_i x n_i.
TEST(Erratum86, TheAngleIsThatBetweenTheAxesOfBothBodies) {
  const Bodies bodies = turned(40 * kDegree);
  const Vec3 ni = bodies.pose[0].q * Vec3::UnitX(), nj = bodies.pose[1].q * Vec3::UnitX();
  EXPECT_EQ(std::asin(ni.cross(ni).norm()), 0);
  EXPECT_NEAR(angleBetween(ni, nj).phi / kDegree, 40, 1e-12);
}

// A cone of 30 degrees entered from 50, and an axle that takes the body to 20: there the cone must
// push by nothing. (90) clamps the increments, which cannot take the first push back.
double conePush90() {
  double theta = 50, total = 0;
  for (int k = 0; k < 30; ++k) {
    const double change = std::min(-(theta - 30), 0.0);  // inwards only
    total += change;
    theta += change;
    theta = 20;
  }
  return total;
}

TEST(Erratum90, TheTotalIsClampedNotItsIncrements) {
  EXPECT_EQ(conePush90(), -20);
  Bodies bodies = turned(50 * kDegree);
  const ConeLimit cone{{0, 1}, {Vec3::UnitX(), Vec3::UnitX()}, 30 * kDegree};
  Mat3 frame;
  frame << Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX();
  const Axle axle{{0, 1}, about({0, 0, 1}, 20 * kDegree) * Vec3::UnitX(), frame};
  Multipliers<ConeLimit> onCone;
  Multipliers<Axle> onAxle;
  for (int k = 0; k < 30; ++k) {
    visit(cone, onCone, bodies);
    visit(axle, onAxle, bodies);
  }
  EXPECT_EQ(onCone.total[0], 0);
  EXPECT_NEAR(angleAt(bodies), 20, 1e-9);
}

// nu g = 3 m/s^2 stops 3 m/s after 1.5 m. With anchors that are never moved on, (96) becomes a
// force towards the start.
TEST(Erratum96, AnchorsThatAreNeverUpdatedPullABlockBackToItsStart) {
  double x = 0, v = 3;
  for (int k = 0; k < 122; ++k) {
    const double free = x + kStep * v, most = 3 * kStep * kStep;
    const double kappa = std::clamp(-free, -most, most);
    v = (free + kappa - x) / kStep;
    x = free + kappa;
  }
  EXPECT_LT(x, 0.1);
  EXPECT_LT(v, -2.7);
  World world = slopeOf(0, {3 / kGravity, 3 / kGravity}, 1);
  world.add(box(Vec3(0.5, 0.1, 0.5), 3));
  runFor(world, 122 * kStep);
  EXPECT_NEAR(place(world).x(), 1.475, 0.01);  // 1.5 less v0 h/2
  EXPECT_LT(speed(world).norm(), 1e-6);
}

// The bracket of (106) at dX = 0 is F h^2: with dX^{k+1} on both sides it would have to vanish.
TEST(Erratum106, TheUpdateStartsFromTheLastIterate) {
  Bodies bodies = bodiesOf({{0, Vec3::Zero(), {}}, {1, Vec3::Zero(), at(Vec3(0.3, 0, 0))}});
  const double kh2 = 400 * kStep * kStep, printedBracket = -kh2 * 0.3;
  EXPECT_GT(std::abs(printedBracket), 0.03);
  iterate(VectorSpring{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 400, 0}, bodies, 1, kStep);
  EXPECT_NEAR(bodies.pose[1].x.x(), 0.3 / (1 + kh2), 1e-15);  // dX = bracket/(1 + k h^2)
}

// (127) prints X^{t+1}, without the displacement so far: two iterations on a mass of 1 kg.
double after127(bool printed, int iterations) {
  const double compliance = 1 / (400 * kStep * kStep);
  double x = 0.3, lambda = 0;
  for (int k = 0; k < iterations; ++k) {
    const double change = (-(printed ? 0.3 : x) - compliance * lambda) / (1 + compliance);
    lambda += change;
    x += change;
  }
  return x;
}

TEST(Erratum127, TheErrorIsThatOfThePresentDisplacement) {
  const double exact = 0.3 / (1 + 400 * kStep * kStep);
  EXPECT_NEAR(after127(false, 20), exact, 1e-15);
  EXPECT_GT(std::abs(after127(true, 20) - exact), 0.001);
  Bodies bodies = bodiesOf({{0, Vec3::Zero(), {}}, {1, Vec3::Zero(), at(Vec3(0.3, 0, 0))}});
  iterate(VectorSpring{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 400, 0}, bodies, 20, kStep);
  EXPECT_NEAR(bodies.pose[1].x.x(), exact, 1e-14);
}

// (129) by the arc sine: at 120 degrees a drive would pull as at 60.
TEST(Erratum129, AnArcSineHalvesTheTorqueAtHundredAndTwentyDegrees) {
  Bodies bodies = turned(120 * kDegree);
  const Vec3 wi = bodies.pose[0].q * Vec3::UnitX(), wj = bodies.pose[1].q * Vec3::UnitX();
  EXPECT_NEAR(std::asin(wi.cross(wj).norm()) / kDegree, 60, 1e-9);
  const Drive drive{{0, 1}};
  EXPECT_NEAR(drive.error(bodies.pose).z() / kDegree, 120, 1e-12);
}

// (130) prints mu dt where nu dt is meant. With the mu of every other section, 1/I^-1, one
// iteration in the plane is not implicit Euler.
TEST(Erratum130, TheDampingInTheInverseIsNu) {
  const double k = 30, nu = 0.5, inertia = 0.1, kh2 = k * kStep * kStep, theta = 0.3, turn = 0.1;
  const auto after = [&](double damping) {  // one iteration from 0.3, where it came by `turn`
    const double pull = kh2 * theta + nu * kStep * turn;
    return theta - pull / inertia / (1 + (kh2 + damping * kStep) / inertia);
  };
  Bodies bodies = turned(theta);
  bodies.start[1].q = about({0, 0, 1}, theta - turn);
  iterate(Drive{{0, 1}, Quat::Identity(), k, nu}, bodies, 1, kStep);
  EXPECT_NEAR(angleAt(bodies) * kDegree, after(nu), 1e-14);
  EXPECT_GT(std::abs(after(inertia) - after(nu)), 1e-3);
}

// (135) prints |x_i - x_{i+1}| for d, whose unit would be 1, whatever the direction.
TEST(Erratum135, TheDifferenceOfTwoNodesIsAVector) {
  const Vec3 along(0.6, 0, 0.8);
  Bodies bodies = bodiesOf({{1, Vec3::Zero(), {}}, {1, Vec3::Zero(), at(2 * along)}});
  const double printed = bodies.pose[1].x.norm();
  EXPECT_EQ(printed / std::abs(printed), 1);
  const auto row = rowOf(Link{{0, 1}, 1}, bodies);
  EXPECT_LT((row.linear[0].transpose() + along).norm(), 1e-15);
  iterate(Link{{0, 1}, 1}, bodies, 1);
  EXPECT_LT((bodies.pose[1].x - 1.5 * along).norm(), 1e-15);
}

}  // namespace
}  // namespace physics::testing
