// Ropes have the nodes, masses and joints that their definitions say.
#include <gtest/gtest.h>

#include "physics/make/rope.h"
#include "tests/physics/make_parts.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {
namespace {

Settings withContact() {
  Settings settings = sweeps();
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  return settings;
}

RopeDef ropeOf(int count) {
  RopeDef def;
  def.to = Vec3(3, 0, 0);
  def.count = count;
  return def;
}

TEST(Rope, HasItsNodesLinksAndOneTotalLength) {
  World world;
  EXPECT_EQ(add(world, ropeOf(10)).size(), 10u);
  EXPECT_EQ(countOf(world, "link"), 9);
  EXPECT_EQ(countOf(world, "rope_length"), 1);
}

TEST(Rope, WeighsItsMassInAll) {
  World world;
  RopeDef def = ropeOf(7);
  def.matter.mass = 2.5;
  add(world, def);
  EXPECT_NEAR(massOf(world), 2.5, 1e-14);
}

TEST(Rope, WeighsAsMuchAsACylinderOfWaterWhereNothingIsSaid) {
  World world;
  add(world, ropeOf(7));
  EXPECT_NEAR(massOf(world), 1000 * 3 * kPi * 0.02 * 0.02, 1e-12);
}

TEST(Rope, WithSlackHangsInAnArcOfItsLengthBetweenItsEnds) {
  for (const Vec3& to : {Vec3(3, 0, 0), Vec3(0, -2, 0), Vec3(1, 2, 1), Vec3(1e-3, 0, 0)}) {
    World world;
    RopeDef def = ropeOf(21);
    def.to = to;
    def.length = 4;
    const std::vector<BodyId> nodes = add(world, def);
    for (size_t i = 1; i < nodes.size(); ++i) {
      EXPECT_NEAR((placeOf(world, nodes[i]) - placeOf(world, nodes[i - 1])).norm(), 0.2, 1e-9);
    }
    EXPECT_LT(placeOf(world, nodes.front()).norm(), 1e-9);
    EXPECT_LT((placeOf(world, nodes.back()) - to).norm(), 1e-9);
    EXPECT_LE(placeOf(world, nodes[10]).y(), 0.5 * to.y() + 1e-9);
  }
}

TEST(Rope, ThatEndsWhereItBeginsIsARing) {
  World world;
  RopeDef def = ropeOf(13);
  def.to = def.from;
  def.length = 6;
  const std::vector<BodyId> nodes = add(world, def);
  for (const BodyId node : nodes) EXPECT_TRUE(placeOf(world, node).allFinite());
  EXPECT_LT((placeOf(world, nodes.back()) - def.from).norm(), 1e-9);
}

TEST(Rope, HangsOnABodyByABallSocketAndOnTheWorldByAPin) {
  World world;
  BodyDef ball;
  ball.shape = Sphere{0.3};
  const BodyId id = world.add(ball);
  RopeDef def = ropeOf(5);
  def.attach = RopeAttachments{BodyRef{kWorldBody}, BodyRef{id}};
  const std::vector<BodyId> nodes = add(world, def);
  EXPECT_EQ(countOf(world, "ball_socket"), 1);
  EXPECT_EQ(world.bodies().motion[nodes.front()], Motion::kStatic);
  EXPECT_EQ(world.bodies().motion[nodes.back()], Motion::kDynamic);
}

// The link at the pin touches the box close to its held end, where the other would have to leap.
TEST(Rope, PinnedInsideABodyDoesNotLeap) {
  World world(withContact());
  BodyDef box;
  box.shape = Box{Vec3(0.3, 0.12, 0.3)};
  box.pose.x = Vec3(0, 0.07, 0);
  box.motion = Motion::kStatic;
  world.add(box);
  RopeDef def = ropeOf(31);
  def.pins = RopePins::kStart;
  const std::vector<BodyId> nodes = add(world, def);
  for (int step = 0; step < 60; ++step) {
    world.step();
    for (const BodyId node : nodes) EXPECT_LT(placeOf(world, node).norm(), 4);
  }
}

TEST(Rope, BendsOverEveryThreeNodesOnRequest) {
  World world;
  RopeDef def = ropeOf(101);
  def.slack = 0.02;
  def.bending.stiffness = 7;
  const std::vector<BodyId> nodes = add(world, def);
  double energy = 0;
  for (size_t i = 2; i < nodes.size(); ++i) {
    const Vec3 c =
        placeOf(world, nodes[i - 2]) - 2 * placeOf(world, nodes[i - 1]) + placeOf(world, nodes[i]);
    energy += 0.5 * 7 * c.squaredNorm();
  }
  EXPECT_GT(energy, 0);
  EXPECT_NEAR(world.springEnergy(), energy, 1e-12 * energy);
}

std::string ropeRefusal(const RopeDef& def) {
  World world;
  try {
    add(world, def);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Rope, RefusesWhatCannotBe) {
  EXPECT_EQ(ropeRefusal(ropeOf(1)), "expected at least 2 nodes");
  RopeDef def = ropeOf(5);
  def.length = 2.5;
  EXPECT_EQ(ropeRefusal(def),
            "expected a length of at least |to - from| = 3.000000 m, got 2.500000 m");
  def = ropeOf(5);
  def.to = def.from;
  EXPECT_EQ(ropeRefusal(def), "expected 'to' away from 'from', or a length");
  def = ropeOf(5);
  def.to.reset();
  EXPECT_EQ(ropeRefusal(def), "expected 'to' or 'direction'");
  def.direction = Vec3::UnitX();
  EXPECT_EQ(ropeRefusal(def), "expected 'length' or 'to', which it follows from");
  def = ropeOf(5);
  def.pins = RopePins::kStart;
  def.attach = RopeAttachments{BodyRef{kWorldBody}, {}};
  EXPECT_EQ(ropeRefusal(def), "expected an end in 'pins' or in 'attach', not in both");
}

}  // namespace
}  // namespace physics::testing
