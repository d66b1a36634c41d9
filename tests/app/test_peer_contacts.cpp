// Other engines where bodies touch, are moved, or cannot be expressed.
#include "tests/app/peer_worlds.h"

namespace tests {
namespace {

using physics::BodyId;
using physics::Vec3;
using physics::World;

class PeerContacts : public Peers {};
INSTANTIATE_TEST_SUITE_P(Methods, PeerContacts, testing::ValuesIn(peerNames()),
                         [](const auto& info) { return info.param; });

std::vector<physics::Shape> shapesOfHalfAMetre() {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) {
    corners.emplace_back(k & 1 ? 0.3 : -0.3, k & 2 ? 0.5 : -0.5, k & 4 ? 0.4 : -0.4);
  }
  return {physics::Box{{0.8, 1, 0.6}}, physics::Sphere{0.5}, physics::Capsule{0.2, 0.6},
          physics::Cylinder{0.3, 1}, physics::Convex{physics::makeHull(corners).hull}};
}

TEST_P(PeerContacts, EveryShapeRestsWhereItStands) {
  SKIP_WHERE_ABSENT();
  World world(touching());
  addGround(world);
  double x = 0;
  for (const physics::Shape& shape : shapesOfHalfAMetre()) addBody(world, shape, {x += 3, 0.5, 0});
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.steps(60, 1.0 / 60);
  for (BodyId i = 2; i < run.world.bodyCount(); ++i) {
    EXPECT_NEAR(run.bodies().pose[i].x.y(), 0.5, 5e-3) << i;
    EXPECT_LT(run.bodies().velocity[i].v.norm(), 0.02) << i;  // ODE's quick step: 0.011
  }
  EXPECT_LT(run.world.largestOverlap(), 5e-3);
  EXPECT_GE(run.world.contacts().size(), 5u);
}

TEST_P(PeerContacts, ABallThatSlidesEndsRollingAtFiveSevenths) {
  SKIP_WHERE_ABSENT();
  World world(touching());
  addGround(world);
  const BodyId ball = addBody(world, physics::Sphere{0.1}, {0, 0.1, 0});
  world.setVelocity(ball, {{5, 0, 0}, Vec3::Zero()});
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.steps(1000, 1e-3);
  EXPECT_NEAR(run.bodies().velocity[ball].v.x(), 5 * 5.0 / 7, 1e-3);
  EXPECT_NEAR(run.bodies().velocity[ball].w.z(), -10 * 5 * 5.0 / 7, 1e-2);
}

TEST_P(PeerContacts, ABallBouncesBackToItsHeight) {
  SKIP_WHERE_ABSENT();
  World world(touching(1));
  addGround(world);
  const BodyId ball = addBody(world, physics::Sphere{0.1}, {0, 1.1, 0});
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  const double energy = physics::measure(run.world).total();
  run.steps(4000, 1e-3);
  EXPECT_NEAR(physics::measure(run.world).total() / energy, 1, 0.02);
  EXPECT_LT(std::abs(run.bodies().pose[ball].x.x()), 1e-12);
}

TEST_P(PeerContacts, PairsThatAreToldToMissEachOtherDo) {
  SKIP_WHERE_ABSENT();
  World world(touching());
  addGround(world);
  const BodyId ball = addBody(world, physics::Sphere{0.1}, {0, 0.5, 0});
  world.ignoreCollision(1, ball);
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.steps(60, 1.0 / 60);
  EXPECT_LT(run.bodies().pose[ball].x.y(), -4);
}

TEST_P(PeerContacts, AMovedBodyMovesWithItsVelocityAndCarriesWhatLiesOnIt) {
  SKIP_WHERE_ABSENT();
  World world(touching());
  physics::BodyDef belt;
  belt.shape = physics::Box{{20, 1, 4}};
  belt.motion = physics::Motion::kKinematic;
  belt.velocity.v = {1, 0, 0};
  world.add(belt);
  const BodyId box = addBody(world, physics::Box{{0.5, 0.5, 0.5}}, {0, 0.75, 0});
  PeerRun run(std::move(world), GetParam());
  SKIP_WHERE_REFUSED(run);
  run.steps(120, 1.0 / 60);
  EXPECT_NEAR(run.bodies().pose[1].x.x(), 2, 1e-12);
  EXPECT_NEAR(run.bodies().velocity[box].v.x(), 1, 1e-2);
}

TEST_P(PeerContacts, WhatCannotBeExpressedIsRefusedWithTheReason) {
  SKIP_WHERE_ABSENT();
  World rope;
  const BodyId a = addBody(rope, physics::PointShape{}, {0, 0, 0});
  const BodyId b = addBody(rope, physics::PointShape{}, {1, 0, 0});
  physics::DistanceDef slack;
  slack.bodies = {a, b};
  slack.rope = true;
  rope.add(slack);
  const app::PeerStart start = app::startPeer(GetParam(), rope);
  EXPECT_EQ(start.peer, nullptr);
  EXPECT_NE(start.refusal.find("slack distance"), std::string::npos) << start.refusal;

  physics::Settings settings = touching();
  settings.contact->friction = {0.6, 0.4};
  World rough(settings);
  addBody(rough, physics::Sphere{0.1}, {0, 1, 0});
  EXPECT_NE(app::startPeer(GetParam(), rough).refusal.find("friction"), std::string::npos);
}

TEST(PeerTable, NamesWhatIsMissingAndRefusesUnknownMethods) {
  for (const app::PeerEngine& engine : app::peerEngines()) {
    EXPECT_FALSE(engine.package.empty());
  }
  EXPECT_THROW(app::startPeer("no_such_engine", World()), std::invalid_argument);
}

}  // namespace
}  // namespace tests
