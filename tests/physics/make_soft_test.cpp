// Ropes, cloths and soft bodies have the nodes, masses and joints that their definitions say.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/make/cloth.h"
#include "physics/make/rope.h"
#include "physics/make/soft_body.h"

namespace physics::testing {
namespace {

int countOf(const World& world, const std::string& kind) {
  for (const KindError& error : world.constraintErrors()) {
    if (error.kind == kind) return error.count;
  }
  int count = 0;  // forces have no error
  for (const JointReport& joint : world.joints()) count += joint.kind == kind ? 1 : 0;
  return count;
}

double massOf(const World& world) {
  double mass = 0;
  for (const double m : world.bodies().mass) mass += m;
  return mass;
}

Vec3 at(const World& world, BodyId body) { return world.bodies().pose[body].x; }

Settings withContact() {
  Settings settings;
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
      EXPECT_NEAR((at(world, nodes[i]) - at(world, nodes[i - 1])).norm(), 0.2, 1e-9);
    }
    EXPECT_LT(at(world, nodes.front()).norm(), 1e-9);
    EXPECT_LT((at(world, nodes.back()) - to).norm(), 1e-9);
    EXPECT_LE(at(world, nodes[10]).y(), 0.5 * to.y() + 1e-9);
  }
}

TEST(Rope, ThatEndsWhereItBeginsIsARing) {
  World world;
  RopeDef def = ropeOf(13);
  def.to = def.from;
  def.length = 6;
  const std::vector<BodyId> nodes = add(world, def);
  for (const BodyId node : nodes) EXPECT_TRUE(at(world, node).allFinite());
  EXPECT_LT((at(world, nodes.back()) - def.from).norm(), 1e-9);
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
    for (const BodyId node : nodes) EXPECT_LT(at(world, node).norm(), 4);
  }
}

std::string refusal(const RopeDef& def) {
  World world;
  try {
    add(world, def);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Rope, RefusesWhatCannotBe) {
  EXPECT_EQ(refusal(ropeOf(1)), "expected at least 2 nodes");
  RopeDef def = ropeOf(5);
  def.length = 2.5;
  EXPECT_EQ(refusal(def), "expected a length of at least |to - from| = 3.000000 m, got 2.500000 m");
  def = ropeOf(5);
  def.to = def.from;
  EXPECT_EQ(refusal(def), "expected 'to' away from 'from', or a length");
  def = ropeOf(5);
  def.to.reset();
  EXPECT_EQ(refusal(def), "expected 'to' or 'direction'");
  def.direction = Vec3::UnitX();
  EXPECT_EQ(refusal(def), "expected 'length' or 'to', which it follows from");
  def = ropeOf(5);
  def.pins = RopePins::kStart;
  def.attach = RopeAttachments{BodyRef{kWorldBody}, {}};
  EXPECT_EQ(refusal(def), "expected an end in 'pins' or in 'attach', not in both");
}

ClothDef clothOf(int wide, int high) {
  ClothDef def;
  def.size = Vec2(2, 1);
  def.nodes = {wide, high};
  return def;
}

TEST(Cloth, HasALinkToEveryNeighbourAndATotalLengthToEveryRowAndColumn) {
  World world;
  const SoftParts parts = add(world, clothOf(5, 4));
  EXPECT_EQ(parts.nodes.size(), 20u);
  EXPECT_EQ(parts.triangles.size(), 2u * 4 * 3);
  EXPECT_EQ(countOf(world, "link"), 4 * 4 + 5 * 3);
  EXPECT_EQ(countOf(world, "rope_length"), 4 + 5);
}

TEST(Cloth, HasTwoDiagonalsToEveryCellAndNoTotalLengthOnRequest) {
  World world;
  ClothDef def = clothOf(5, 4);
  def.shear = true;
  def.totalLength = false;
  add(world, def);
  EXPECT_EQ(countOf(world, "link"), 4 * 4 + 5 * 3 + 2 * 4 * 3);
  EXPECT_EQ(countOf(world, "rope_length"), 0);
}

TEST(Rope, BendsOverEveryThreeNodesOnRequest) {
  World world;
  RopeDef def = ropeOf(101);
  def.slack = 0.02;
  def.bending.stiffness = 7;
  const std::vector<BodyId> nodes = add(world, def);
  double energy = 0;
  for (size_t i = 2; i < nodes.size(); ++i) {
    const Vec3 c = at(world, nodes[i - 2]) - 2 * at(world, nodes[i - 1]) + at(world, nodes[i]);
    energy += 0.5 * 7 * c.squaredNorm();
  }
  EXPECT_GT(energy, 0);
  EXPECT_NEAR(world.springEnergy(), energy, 1e-12 * energy);
}

TEST(Cloth, LiesAboutItsMiddleWithItsFrontUp) {
  World world;
  ClothDef def = clothOf(3, 3);
  def.position = Vec3(1, 2, 3);
  const SoftParts parts = add(world, def);
  EXPECT_LT((at(world, parts.nodes[0]) - Vec3(0, 2, 2.5)).norm(), 1e-15);
  EXPECT_LT((at(world, parts.nodes[4]) - def.position).norm(), 1e-15);
  double area = 0;
  for (const auto& [a, b, c] : parts.triangles) {
    const Vec3 p = at(world, parts.nodes[a]);
    const Vec3 normal = (at(world, parts.nodes[b]) - p).cross(at(world, parts.nodes[c]) - p) / 2;
    EXPECT_GT(normal.y(), 0);
    area += normal.y();
  }
  EXPECT_NEAR(area, 2, 1e-14);
}

TEST(Cloth, PinsWhatItsWordsSay) {
  const auto pinned = [](ClothPins pins, std::vector<GridIndex> more) {
    World world;
    ClothDef def = clothOf(5, 4);
    def.pins = pins;
    def.pinned = std::move(more);
    int count = 0;
    for (const BodyId node : add(world, def).nodes) {
      count += world.bodies().motion[node] == Motion::kStatic ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(pinned(ClothPins::kNone, {}), 0);
  EXPECT_EQ(pinned(ClothPins::kTwoCorners, {}), 2);
  EXPECT_EQ(pinned(ClothPins::kFourCorners, {}), 4);
  EXPECT_EQ(pinned(ClothPins::kTopRow, {}), 5);
  EXPECT_EQ(pinned(ClothPins::kNone, {{2, 3}, {2, 3}, {4, 0}}), 2);
  EXPECT_THROW(pinned(ClothPins::kNone, {{5, 0}}), std::invalid_argument);
  EXPECT_THROW(pinned(ClothPins::kNone, {{0, -1}}), std::invalid_argument);
}

TEST(Cloth, RefusesAxesThatAreParallelAndGridsOfOneRow) {
  World world;
  ClothDef def = clothOf(5, 4);
  def.v = -def.u;
  EXPECT_THROW(add(world, def), std::invalid_argument);
  EXPECT_THROW(add(world, clothOf(5, 1)), std::invalid_argument);
}

SoftBodyDef softBox() {
  SoftBodyDef def;
  def.box = TetBox{Vec3(1, 0.5, 0.25), {3, 2, 2}};
  return def;
}

TEST(SoftBody, HasItsVolumesAndEdges) {
  World world;
  const SoftParts parts = add(world, softBox());
  EXPECT_EQ(parts.nodes.size(), 4u * 3 * 3);
  EXPECT_EQ(countOf(world, "volume"), 5 * 12);
  EXPECT_EQ(countOf(world, "spring"),
            static_cast<int>(edgesOf(boxMesh(Vec3::Ones(), {3, 2, 2})).size()));
}

TEST(SoftBody, WeighsItsVolumeTimesItsDensityOrItsMass) {
  SoftBodyDef def = softBox();
  World water, heavy, twice;
  add(water, def);
  EXPECT_NEAR(massOf(water), 125, 1e-10);
  def.matter.mass = 3;
  add(heavy, def);
  EXPECT_NEAR(massOf(heavy), 3, 1e-13);
  def.matter = {};
  def.scale = 2;
  add(twice, def);
  EXPECT_NEAR(massOf(twice), 1000, 1e-9);
}

TEST(SoftBody, NodesWeighAQuarterOfTheirTetrahedra) {
  World world;
  SoftBodyDef def;
  def.mesh = TetMesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, {{0, 2, 1, 3}}};
  def.matter.density = 600;
  for (const BodyId node : add(world, def).nodes) {
    EXPECT_NEAR(world.bodies().mass[node], 600.0 / 6 / 4, 1e-12);
  }
}

TEST(SoftBody, PinsTheNodesOfOneSideOfItsOwn) {
  World world;
  SoftBodyDef def = softBox();
  def.pins = SoftPins::kLeft;
  def.place.rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));  // left is down
  int count = 0;
  for (const BodyId node : add(world, def).nodes) {
    if (world.bodies().motion[node] != Motion::kStatic) continue;
    EXPECT_NEAR(at(world, node).y(), -0.5, 1e-14);
    ++count;
  }
  EXPECT_EQ(count, 9);
}

TEST(SoftBody, WantsABoxOrAMesh) {
  World world;
  EXPECT_THROW(add(world, SoftBodyDef{}), std::invalid_argument);
}

}  // namespace
}  // namespace physics::testing
