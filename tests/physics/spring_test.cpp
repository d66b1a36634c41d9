// Spring and damper, (108)-(127).
#include <gtest/gtest.h>

#include "physics/world.h"
#include "tests/physics/pair.h"
#include "tests/physics/points.h"

namespace physics::testing {
namespace {

SpringDef springOf(BodyId a, BodyId b, double stiffness, double damping, double rest) {
  SpringDef def;
  def.bodies = {a, b};
  def.stiffness = stiffness;
  def.damping = damping;
  def.restLength = rest;
  return def;
}

TEST(Spring, EqualsImplicitEulerOfOneDimension) {
  constexpr double kMass = 2, kStiffness = 300, kDamping = 1.5, kRest = 1;
  World world(steps(1, 1));
  const BodyId body = world.add(point(kMass, Vec3(1.4, 0, 0)));
  world.add(springOf(kWorldBody, body, kStiffness, kDamping, kRest));
  double stretch = 0.4, speed = 0;
  for (int k = 0; k < 300; ++k) {
    world.step();
    speed = (kMass * speed - kStep * kStiffness * stretch) /
            (kMass + kStep * kDamping + kStep * kStep * kStiffness);
    stretch += kStep * speed;
    ASSERT_NEAR(world.bodies().pose[body].x.x(), kRest + stretch, 1e-13) << "step " << k;
  }
}

TEST(Spring, TwoInARowReachImplicitEulerWithTheIterations) {
  constexpr double kStiffness = 400;
  World world(steps(1, 200));
  const BodyId a = world.add(point(1, Vec3(1.3, 0, 0))), b = world.add(point(2, Vec3(2.1, 0, 0)));
  world.add(springOf(kWorldBody, a, kStiffness, 0, 1));
  world.add(springOf(a, b, kStiffness, 0, 1));
  world.step();
  // (M + h^2 K) v = -h K u: stretches .3 and -.2.
  Eigen::Matrix2d stiffness, mass;
  stiffness << 2, -1, -1, 1;
  mass << 1, 0, 0, 2;
  const Eigen::Matrix2d left = mass + kStep * kStep * kStiffness * stiffness;
  const Vec2 force(kStiffness * (-0.3 - 0.2), kStiffness * 0.2);
  const Vec2 v = left.inverse() * (kStep * force);
  EXPECT_NEAR(world.bodies().velocity[a].v.x(), v[0], 1e-11);
  EXPECT_NEAR(world.bodies().velocity[b].v.x(), v[1], 1e-11);
}

TEST(Spring, ConvergesToTheExactMotionWithOrderOne) {
  const auto errorAt = [](int substeps) {  // x = cos t after 1 s
    Settings settings = steps(1, 1);
    settings.substeps = substeps;
    World world(settings);
    const BodyId body = world.add(point(1, Vec3(2, 0, 0)));
    world.add(springOf(kWorldBody, body, 1, 0, 1));
    for (int k = 0; k < 60; ++k) world.step();
    return world.bodies().pose[body].x.x() - 1 - std::cos(1.0);
  };
  EXPECT_NEAR(errorAt(4) / errorAt(8), 2, 0.02);
}

// (123) with the 1 x 1 resistance A along the spring.
double update123(double lambda, double a, double k, double nu, double c, double speed) {
  const double h = kStep, alpha = k * h * h + nu * h;
  return (alpha * a * lambda - k * h * h * c - nu * h * speed * h) / (1 + alpha * a);
}

// (127) with the misprint mended: grad C M^-1 grad C^T, and C at the current X^{t+1} + Delta X.
double update127(double lambda, double a, double k, double nu, double c, double speed) {
  const double compliance = 1 / (k * kStep * kStep), gamma = nu / (k * kStep);
  return lambda +
         (-c - gamma * speed * kStep - compliance * lambda) / ((1 + gamma) * a + compliance);
}

// One visit to a spring between turning bodies, against a formula for the multiplier.
template <class Update>
void expectIterates(Update update) {
  Random random(5);
  Bodies bodies = randomPair(random);
  displace(bodies.start[0], Vec3(0.02, 0.01, 0), Vec3(0.1, 0, 0.05));
  const Spring item{{0, 1}, {Vec3(0.3, 0.1, 0), Vec3(0, -0.4, 0.2)}, 800, 3, 0.5};
  Multipliers<Spring> lambda;
  for (int k = 0; k < 5; ++k) {
    const auto gap = [&](const std::vector<Pose>& pose) {
      return ((pose[0].x + pose[0].q * item.anchors[0]) - (pose[1].x + pose[1].q * item.anchors[1]))
          .norm();
    };
    Response<Spring> response;
    const double a =
        effectiveMassInverse(item, rowOf(item, bodies), bodies.inverse, response)(0, 0);
    const double now = gap(bodies.pose), speed = (now - gap(bodies.start)) / kStep;
    const double expected = update(lambda.total[0], a, 800, 3, now - 0.5, speed);
    visit(item, lambda, bodies, kStep);
    EXPECT_NEAR(lambda.total[0], expected, 1e-14 * std::abs(expected)) << "iterate " << k;
  }
}

TEST(Spring, EveryIterateIsThatOf123) { expectIterates(update123); }

TEST(Erratum127, EqualsOneHundredAndTwentyThreeAtEveryIterate) { expectIterates(update127); }

TEST(Spring, WithoutStiffnessAndDampingIsNoRow) {
  Bodies bodies = bodiesOf({{}, {1, Vec3::Ones(), at(Vec3(2, 0, 0))}});
  const auto lambda = iterate(Spring{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 0, 0, 1}, bodies, 3);
  EXPECT_EQ(lambda.total[0], 0);
}

TEST(Spring, OfHugeStiffnessIsARod) {
  Bodies bodies = bodiesOf({{}, {1, Vec3::Ones(), at(Vec3(2, 0, 0))}});
  iterate(Spring{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 1e14, 0, 1}, bodies, 1);
  EXPECT_NEAR(bodies.pose[1].x.x() - bodies.pose[0].x.x(), 1, 1e-9);  // 1/(k h^2 A) = 2e-11
}

}  // namespace
}  // namespace physics::testing
