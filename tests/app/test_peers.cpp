// Other engines step our worlds, and our code measures them.
#include "tests/app/peer_worlds.h"

namespace tests {
namespace {

using physics::BodyId;
using physics::Vec3;
using physics::World;

INSTANTIATE_TEST_SUITE_P(Methods, Peers, testing::ValuesIn(peerNames()),
                         [](const auto& info) { return info.param; });

World makeTwoBars() {  // turned, moving, joined: all of a state but contacts
  World world = makeBar();
  physics::BodyDef def;
  def.shape = physics::Box{{0.2, 0.3, 0.4}};
  def.mass = 3;
  def.pose = {{5, 6, 7}, physics::Quat(0.1, 0.7, -0.5, 0.3).normalized()};
  def.velocity = {{0.1, 0.2, 0.3}, {1.1, -0.7, 0.4}};
  world.add(def);
  return world;
}

TEST_P(Peers, StartAtTheStateOfTheWorldBitForBit) {
  SKIP_WHERE_ABSENT();
  PeerRun run(makeTwoBars(), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.start.peer->read(run.pose, run.velocity);
  for (BodyId i = 0; i < run.world.bodyCount(); ++i) {
    EXPECT_EQ(run.pose[i].x, run.bodies().pose[i].x);
    EXPECT_EQ(run.velocity[i].v, run.bodies().velocity[i].v);
    // MuJoCo keeps the turn of a free body in the body's own frame: there and back rounds.
    EXPECT_LE((run.velocity[i].w - run.bodies().velocity[i].w).norm(),
              GetParam() == "mujoco" ? 1e-15 : 0);
    // Bullet keeps matrices: the way there and back rounds a few times.
    EXPECT_LT(run.pose[i].q.angularDistance(run.bodies().pose[i].q), 1e-15);
  }
}

TEST_P(Peers, AreWrittenBackAsTheyAre) {
  SKIP_WHERE_ABSENT();
  PeerRun run(makeTwoBars(), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.steps(10, 0.01);
  for (BodyId i = 1; i < run.world.bodyCount(); ++i) {
    EXPECT_EQ(run.bodies().pose[i].x, run.pose[i].x);
    EXPECT_EQ(run.bodies().velocity[i].v, run.velocity[i].v);
    EXPECT_EQ(run.bodies().velocity[i].w, run.velocity[i].w);
    EXPECT_LT(run.bodies().pose[i].q.angularDistance(run.pose[i].q), 1e-15);
  }
}

TEST_P(Peers, FallAsSymplecticEulerFalls) {
  SKIP_WHERE_ABSENT();
  World world(falling());
  const BodyId ball = addBody(world, physics::Sphere{0.1}, {1, 5, 2});
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  constexpr int kSteps = 60;
  constexpr double h = 1.0 / 60;
  run.steps(kSteps, h);
  EXPECT_NEAR(run.bodies().pose[ball].x.y(), 5 - kGravity * h * h * kSteps * (kSteps + 1) / 2,
              1e-13);
  EXPECT_NEAR(run.bodies().velocity[ball].v.y(), -kGravity * h * kSteps, 1e-13);
  EXPECT_EQ(run.bodies().pose[ball].x.x(), 1);
}

TEST_P(Peers, SpringsPullAsExplicitForces) {
  SKIP_WHERE_ABSENT();
  World world;
  const BodyId ball = addBody(world, physics::Sphere{0.1}, {1.5, 0, 0});
  physics::SpringDef spring;
  spring.bodies = {physics::kWorldBody, ball};
  spring.stiffness = 40;
  spring.damping = 0.7;
  spring.restLength = 1;
  world.add(spring);
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  constexpr double h = 0.01;
  run.steps(100, h);
  double x = 1.5, v = 0;
  for (int k = 0; k < 100; ++k) {
    v += h * (-40 * (x - 1) - 0.7 * v);
    x += h * v;
  }
  EXPECT_NEAR(run.bodies().pose[ball].x.x(), x, 1e-12);
}

// Angle of a bar that falls from the horizontal, (1/3) m L^2 with the width's part: Runge-Kutta.
double barAngle(double time) {
  const double inertia = (kBar * kBar + 0.01) / 12 + kBar * kBar / 4;
  const auto bend = [&](double a) { return -kGravity * kBar / 2 * std::cos(a) / inertia; };
  constexpr int kSteps = 10000;
  const double h = time / kSteps;
  double a = 0, w = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double a1 = w, w1 = bend(a), a2 = w + h / 2 * w1, w2 = bend(a + h / 2 * a1);
    const double a3 = w + h / 2 * w2, w3 = bend(a + h / 2 * a2), a4 = w + h * w3;
    const double w4 = bend(a + h * a3);
    a += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    w += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4);
  }
  return a;
}

double barError(const std::string& method, double h, double time) {
  PeerRun run(makeBar(), method);
  run.steps(static_cast<int>(std::lround(time / h)), h);
  const double a = barAngle(time);
  return (run.bodies().pose[1].x - kBar / 2 * Vec3(std::cos(a), std::sin(a), 0)).norm();
}

TEST_P(Peers, SwingABarAsItSwingsWhenTheStepGoesToZero) {
  SKIP_WHERE_ABSENT();
  const double coarse = barError(GetParam(), 4e-3, 2), fine = barError(GetParam(), 1e-3, 2);
  EXPECT_LT(fine, 5e-3);
  EXPECT_LT(fine, 0.4 * coarse);  // first order: 0.25
}

}  // namespace
}  // namespace tests
