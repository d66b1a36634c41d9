// The least action (10)-(12), constrained (19)-(24), and what its symmetries keep (74)-(79).
#include <gtest/gtest.h>

#include <cmath>

#include "physics/world.h"
#include "tests/physics/points.h"
#include "tests/physics/trial.h"

namespace physics::testing {
namespace {

constexpr double kMass = 2;
const Vec3 kPull(1, -9.81, 0);

Settings oneStep() {
  Settings settings;
  settings.dt = kStep;
  settings.substeps = 1;
  settings.method = Method::kDirect;
  settings.iterations = 12;
  settings.gravity = kPull;
  return settings;
}

using Path = std::vector<Vec3>;

Path pathOf(World& world, int steps) {
  Path path{world.bodies().pose[1].x};
  for (int k = 0; k < steps; ++k) {
    world.step();
    path.push_back(world.bodies().pose[1].x);
  }
  return path;
}

BodyDef thrown() {
  BodyDef def;
  def.mass = kMass;
  def.pose.x = Vec3(1, 0, 0);
  def.velocity.v = Vec3(0, 2, 1.5);
  return def;
}

// The integral of L = m/2 v^2 + m g x over the steps of a path, (10),(13).
double action(const Path& path) {
  double sum = 0;
  for (std::size_t n = 0; n + 1 < path.size(); ++n) {
    const Vec3 v = (path[n + 1] - path[n]) / kStep;
    sum += kStep * kMass * (0.5 * v.squaredNorm() + kPull.dot(path[n]));
  }
  return sum;
}

// dS/dx_n for the ends held fast, (11): minus what (12) is, times h.
Vec3 variation(Path path, std::size_t n) {
  Vec3 slope;
  for (int k = 0; k < 3; ++k) {
    const Vec3 x = path[n], d = 1e-4 * Vec3::Unit(k);
    path[n] = x + d;
    const double ahead = action(path);
    path[n] = x - d;
    slope[k] = (ahead - action(path)) / 2e-4;
    path[n] = x;
  }
  return slope;
}

TEST(Action, OfAFallIsStationary) {
  World world(oneStep());
  world.add(thrown());
  const Path path = pathOf(world, 20);
  for (std::size_t n = 1; n < 20; ++n) EXPECT_LT(variation(path, n).norm(), 1e-9);
  Path other = path;
  other[7] += Vec3(0, 0.01, 0);
  EXPECT_GT(variation(other, 7).norm(), 1);
  EXPECT_GT(action(other), action(path));
}

// (20),(23): m (x'' - g) = -dS/dx_n / h is J^T lambda, along the gradient at the end of the step,
// and c = 0 there (24).
TEST(Action, OfAPendulumChangesOnlyAlongTheGradientOfItsConstraint) {
  World world(oneStep());
  LinkDef link;
  link.bodies = {kWorldBody, world.add(thrown())};
  world.add(link);
  const Path path = pathOf(world, 20);
  for (std::size_t n = 1; n < 20; ++n) {
    const Vec3 along = path[n + 1], slope = variation(path, n);
    EXPECT_GT(slope.norm(), 0.03);
    EXPECT_LT(slope.cross(along).norm(), 1e-7 * slope.norm()) << n;
    EXPECT_NEAR(along.norm(), 1, 1e-12);
  }
}

// (74) prints dL/dx where dL/dv stands: a force would be the rate of the force.
TEST(Erratum74, AForceIsTheRateOfTheMomentum) {
  Bodies bodies = bodiesOf({{0, Vec3::Zero(), {}}, {1, Vec3::Zero(), at(Vec3(1, 0, 0))}});
  const double h = 1e-3;
  const VectorSpring spring{{0, 1}, {Vec3::Zero(), Vec3::Zero()}, 1, 0};
  double forceBefore = -1, speed = 0;
  for (int k = 0; k < 200; ++k) {
    moveFreely(bodies, std::vector<Load>(2), {}, h);
    iterate(spring, bodies, 1, h);
    finishVelocities(bodies, h);
    const double force = -bodies.pose[1].x.x(), rate = (bodies.velocity[1].v.x() - speed) / h;
    EXPECT_NEAR(rate, force, 1e-9);
    EXPECT_GT(std::abs((force - forceBefore) / h - force), 0.5);  // printed
    forceBefore = force;
    speed = bodies.velocity[1].v.x();
  }
}

// (77) prints the rate of P for P. That sum is constant under a steady torque too, where the
// momentum is not.
TEST(Erratum77, APrintedSumThatIsConstantKeepsNoMomentum) {
  Bodies bodies = bodiesOf({{1, Vec3::Ones(), {}}});
  const Load load{Vec3::Zero(), Vec3(0, 0, 2)};
  std::vector<double> momentum{0};
  for (int k = 0; k < 3; ++k) {
    moveFreely(bodies, {&load, 1}, {}, kStep);
    momentum.push_back(bodies.velocity[0].w.z());
  }
  const auto rate = [&](int k) { return (momentum[k + 1] - momentum[k]) / kStep; };
  EXPECT_NEAR(rate(2), rate(0), 1e-12);        // the printed sum, for a turn about z
  EXPECT_GT(momentum[3] - momentum[0], 0.09);  // sum of P . dX
}

class Noether : public EveryKindTest {};

TEST_P(Noether, ShiftingEverythingLeavesTheError) {  // (74)
  if (GetParam().isExternal) GTEST_SKIP() << "a force of the surroundings";
  Random random(42);
  for (int n = 0; n < 50; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    const PlainRow before = trial->rowAt(bodies);
    if (before.hasLinear) {
      Mat3 sum = Mat3::Zero();
      for (const Mat3& block : before.linear) sum += block;
      EXPECT_LT(sum.norm(), 1e-13 * before.linear[0].norm());
    }
    const Vec3 shift = random.inBall(3);
    for (int b = 0; b < bodies.size(); ++b) bodies.pose[b].x += shift, bodies.start[b].x += shift;
    EXPECT_LT((trial->rowAt(bodies).c - before.c).norm(), 1e-13 * (1 + before.c.norm()));
  }
}

TEST_P(Noether, TurningEverythingTurnsTheErrorWithIt) {  // (75),(79)
  if (GetParam().isExternal) GTEST_SKIP() << "a force of the surroundings";
  Random random(43);
  for (int n = 0; n < 50; ++n) {
    Bodies bodies = some(random);
    const auto trial = trialOf(random, bodies);
    const double before = trial->rowAt(bodies).c.norm();
    const Quat turn = random.rotation(kPi);
    for (std::vector<Pose>* poses : {&bodies.pose, &bodies.start}) {
      for (Pose& pose : *poses) pose = {turn * pose.x, turn * pose.q};
    }
    EXPECT_NEAR(trial->rowAt(bodies).c.norm(), before, 1e-12 * (1 + before));
  }
}

TEST_P(Noether, AScalarErrorTurnsNothing) {  // (76)-(78): sum of x x J + J_theta = 0
  if (GetParam().isExternal) GTEST_SKIP() << "a force of the surroundings";
  Random random(44);
  for (int n = 0; n < 50; ++n) {
    Bodies bodies = some(random);
    const PlainRow row = trialOf(random, bodies)->rowAt(bodies);
    if (row.rows > 1) GTEST_SKIP() << "an error of several rows";
    Vec3 sum = Vec3::Zero();
    for (int b = 0; b < bodies.size(); ++b) {
      sum += bodies.pose[b].x.cross(row.linear[b].row(0).transpose());
      sum += row.angular[b].row(0).transpose();
    }
    EXPECT_LT(sum.norm(), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Noether, ::testing::ValuesIn(kindsOfTrials()), wordOf);

}  // namespace
}  // namespace physics::testing
