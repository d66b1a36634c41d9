// Whole joints in other engines: limits, ball and socket, slider, universal joint.
#include "tests/app/peer_worlds.h"

namespace tests {
namespace {

using physics::BodyId;
using physics::Vec3;
using physics::World;

class PeerJoints : public Peers {};
INSTANTIATE_TEST_SUITE_P(Methods, PeerJoints, testing::ValuesIn(peerNames()),
                         [](const auto& info) { return info.param; });

TEST_P(PeerJoints, StopAtTheLimitOfAHinge) {
  SKIP_WHERE_ABSENT();
  World world = makeBar();
  physics::TwistLimitDef limit;
  limit.bodies = {physics::kWorldBody, 1};
  limit.axis = {0, 0, 1};
  limit.range = {-0.6, 0.3};  // it falls to negative angles
  world.add(limit);
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.steps(2000, 1e-3);
  const Vec3& x = run.bodies().pose[1].x;
  EXPECT_NEAR(std::atan2(x.y(), x.x()), -0.6, 0.02);
}

// A bar along x on a ball joint whose cone is about x.
World makeConedBar(const physics::Settings& settings, const physics::Velocity& velocity) {
  World world(settings);
  const BodyId bar = addBody(world, physics::Box{{1, 0.2, 0.1}}, {0.5, 0, 0});
  world.setVelocity(bar, velocity);
  physics::BallSocketDef ball;
  ball.bodies = {physics::kWorldBody, bar};
  world.add(ball);
  physics::ConeLimitDef cone;
  cone.bodies = ball.bodies;
  cone.axes = {{Vec3::UnitX(), Vec3::UnitX()}};
  cone.angle = 0.5;
  world.add(cone);
  physics::TwistLimitDef twist;
  twist.bodies = ball.bodies;
  twist.axis = Vec3::UnitX();
  twist.range = {-0.2, 0.7};
  world.add(twist);
  return world;
}

TEST_P(PeerJoints, StopAtTheConeOfABall) {
  SKIP_WHERE_ABSENT();
  PeerRun run(makeConedBar(falling(), {}), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.steps(3000, 1e-3);
  const Vec3& x = run.bodies().pose[1].x;
  EXPECT_NEAR(std::atan2(-x.y(), std::hypot(x.x(), x.z())), 0.5, 0.03);
}

TEST_P(PeerJoints, StopAtBothEndsOfTheTwistOfABall) {
  SKIP_WHERE_ABSENT();
  for (const double way : {1.0, -1.0}) {
    PeerRun run(makeConedBar(physics::testing::sweeps(), {{0, 0, 0}, {2 * way, 0, 0}}), GetParam());
    SKIP_WHERE_REFUSED(run);
    double most = 0;
    for (int k = 0; k < 1000; ++k) {
      run.steps(1, 1e-3);
      const physics::Quat& q = run.bodies().pose[1].q;
      most = std::max(most, way * 2 * std::atan2(q.x(), q.w()));
    }
    EXPECT_NEAR(most, way > 0 ? 0.7 : 0.2, 0.03);
  }
}

World makeSpacePendulum() {
  World world(falling());
  physics::BodyDef def;
  def.shape = physics::Box{{1, 0.2, 0.1}};
  def.pose.x = {0.5, 0, 0};
  def.velocity = {{0, 0, -1}, {3, 2, 0}};
  physics::BallSocketDef joint;
  joint.bodies = {physics::kWorldBody, world.add(def)};
  world.add(joint);
  return world;
}

TEST_P(PeerJoints, SwingInSpaceAsWeDo) {
  SKIP_WHERE_ABSENT();
  constexpr double h = 1.0 / 8000;
  PeerRun run(makeSpacePendulum(), GetParam());
  SKIP_WHERE_REFUSED(run);
  const physics::Measures before = physics::measure(run.world);
  run.steps(4000, h);
  const physics::Measures after = physics::measure(run.world);
  EXPECT_NEAR(after.total(), before.total(), 0.02);
  EXPECT_NEAR(after.angularMomentum.y(), before.angularMomentum.y(), 2e-3);  // gravity along y
  World ours = makeSpacePendulum();
  while (ours.stepCount() * ours.settings().dt < 0.5 - 1e-9) ours.step();
  // Both of first order: ours takes 4 substeps of 1/60 s.
  EXPECT_LT((run.bodies().pose[1].x - ours.bodies().pose[1].x).norm(), 0.03);
}

World makeSlider(const Vec3& speed) {
  World world(falling());
  const BodyId box = addBody(world, physics::Box{{1, 0.2, 0.1}}, {0.5, 1, 0});
  world.setVelocity(box, {speed, Vec3::Zero()});
  physics::PrismaticDef slider;
  slider.bodies = {physics::kWorldBody, box};
  slider.at = {0, 1, 0};
  slider.axis = {3, -4, 0};
  add(world, slider);
  return world;
}

TEST_P(PeerJoints, SlideDownARailAsTheirIntegratorSlides) {
  SKIP_WHERE_ABSENT();
  PeerRun run(makeSlider({0.6, -0.8, 0}), GetParam());
  SKIP_WHERE_REFUSED(run);
  constexpr double h = 1e-3;
  run.steps(500, h);
  const bool exact = GetParam().ends_with("rk4");  // the others: symplectic Euler
  const double way = 0.5 + 0.8 * kGravity * h * h * 500 * (exact ? 500 : 501) / 2;
  EXPECT_LT((run.bodies().pose[1].x - Vec3(0.5 + 0.6 * way, 1 - 0.8 * way, 0)).norm(), 1e-5);
  EXPECT_LT(run.bodies().velocity[1].w.norm(), 1e-4);
}

TEST_P(PeerJoints, KeepTheAxesOfAUniversalJointSquare) {
  SKIP_WHERE_ABSENT();
  World world(falling());
  const BodyId bar = addBody(world, physics::Box{{1, 0.2, 0.1}}, {0.5, 0, 0});
  physics::UniversalDef joint;
  joint.bodies = {physics::kWorldBody, bar};
  joint.directions = {Vec3::UnitZ(), Vec3::UnitY()};
  add(world, joint);
  world.setVelocity(bar, {{0, 0.5, -0.5}, {0, 1, 1}});
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.steps(300, 1e-3);
  for (const physics::KindError& error : run.world.constraintErrors()) {
    EXPECT_LT(error.largest, 1e-3) << error.kind;
  }
  EXPECT_LT(run.bodies().pose[bar].x.y(), 0.2);
  EXPECT_NE(run.bodies().pose[bar].x.z(), 0);
}

}  // namespace
}  // namespace tests
