// A pendulum of a World against the elliptic integral: the scheme converges, with order one.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/world.h"
#include "physics/world/measure.h"
#include "tests/physics/gravity.h"
#include "tests/physics/sweeps.h"

namespace physics {
namespace {

constexpr double kAmplitude = 1;  // rad
constexpr double kLength = 1;
using testing::kGravity;

// 2 pi sqrt(l/g) / agm(1, cos(a/2))
double exactPeriod() {
  double a = 1, b = std::cos(kAmplitude / 2);
  for (int k = 0; k < 6; ++k) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * std::acos(-1.0) * std::sqrt(kLength / kGravity) / a;
}

World pendulum(int stepsPerSecond) {
  Settings settings = testing::sweeps();
  settings.dt = 1.0 / stepsPerSecond;
  settings.substeps = 1;
  settings.iterations = 4;
  settings.gravity = Vec3(0, -kGravity, 0);
  World world(settings);
  BodyDef bob;
  bob.pose.x = kLength * Vec3(std::sin(kAmplitude), -std::cos(kAmplitude), 0);
  const BodyId body = world.add(bob);
  DistanceDef rod;
  rod.bodies = {kWorldBody, body};
  world.add(rod);
  return world;
}

// From the first passage through the lowest point to the third, by interpolation.
double measuredPeriod(int stepsPerSecond) {
  World world = pendulum(stepsPerSecond);
  double first = 0, last = world.bodies().pose[1].x.x();
  for (int step = 1, passages = 0; step < 10 * stepsPerSecond; ++step) {
    world.step();
    const double now = world.bodies().pose[1].x.x();
    if ((now > 0) != (last > 0)) {
      const double time = (step - now / (now - last)) / stepsPerSecond;
      if (++passages == 1) first = time;
      if (passages == 3) return time - first;
    }
    last = now;
  }
  return 0;
}

TEST(Pendulum, PeriodConvergesToTheEllipticIntegralWithOrderOne) {
  const double exact = exactPeriod();
  const double coarse = measuredPeriod(1000) - exact, fine = measuredPeriod(2000) - exact,
               finer = measuredPeriod(4000) - exact;
  EXPECT_NEAR(coarse / fine, 2, 0.1);
  EXPECT_NEAR(fine / finer, 2, 0.05);
  EXPECT_NEAR(2 * finer - fine, 0, 3e-5);  // extrapolated to h = 0; O(h^2), measured 1.1e-5
}

TEST(Pendulum, NeverGainsEnergy) {
  World world = pendulum(60);
  double last = measure(world).total();
  for (int k = 0; k < 600; ++k) {
    world.step();
    const double now = measure(world).total();
    EXPECT_LE(now, last + 1e-12);
    last = now;
  }
}

// NOTES 3.4: omega = omega0 / sqrt(1 + 2 omega0^2 h t), measured there to 0.5 %.
TEST(Dumbbell, LosesItsSpinByTheLawOfTheScheme) {
  Settings settings = testing::sweeps();
  settings.dt = 1.0 / 60;
  settings.substeps = 1;
  settings.iterations = 20;
  World world(settings);
  const double spin = 2 * std::acos(-1.0);
  BodyDef def;
  for (const double side : {-0.5, 0.5}) {
    def.pose.x = Vec3(side, 0, 0);
    def.velocity.v = Vec3(0, side * spin, 0);
    world.add(def);
  }
  DistanceDef rod;
  rod.bodies = {1, 2};
  world.add(rod);
  const double before = measure(world).angularMomentum.z();
  for (int k = 0; k < 60; ++k) world.step();
  const double kept = measure(world).angularMomentum.z() / before;
  EXPECT_NEAR(kept, 1 / std::sqrt(1 + 2 * spin * spin / 60), 0.005);
}

}  // namespace
}  // namespace physics
