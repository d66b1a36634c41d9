// Cloths and soft bodies have the nodes, masses and joints that their definitions say.
#include <gtest/gtest.h>

#include "physics/make/cloth.h"
#include "physics/make/soft_body.h"
#include "tests/physics/make_parts.h"

namespace physics::testing {
namespace {

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

TEST(Cloth, ThatIsScatteredHasTheLengthsOfOneThatIsNot) {
  World flat, scattered;
  ClothDef def = clothOf(5, 4);
  def.shear = true;
  def.pins = ClothPins::kTopRow;
  const SoftParts at = add(flat, def);
  def.scatter = 0.3;
  const SoftParts parts = add(scattered, def);
  double farthest = 0;
  for (int k = 0; k < 20; ++k) {
    const double off = (placeOf(scattered, parts.nodes[k]) - placeOf(flat, at.nodes[k])).norm();
    farthest = std::max(farthest, off);
    if (k < 5) {
      EXPECT_EQ(off, 0);  // pinned
    }
  }
  EXPECT_GT(farthest, 0.1);
  EXPECT_LE(farthest, 0.3);
  for (const KindError& error : flat.constraintErrors()) EXPECT_LT(error.largest, 1e-12);
  std::vector<Pose> poses = flat.bodies().pose;
  ASSERT_TRUE(scattered.setState(poses, flat.bodies().velocity));
  for (const KindError& error : scattered.constraintErrors()) {
    EXPECT_LT(error.largest, 1e-12) << error.kind;
  }
}

TEST(SoftBody, MayStartFlatOrInsideOut) {
  for (const double height : {0.0, -1.0}) {
    World world;
    SoftBodyDef def;
    def.box = TetBox{Vec3::Ones(), {2, 2, 2}};
    def.startScale = Vec3(1, height, 1);
    add(world, def);
    for (const KindError& error : world.constraintErrors()) {
      if (error.kind != "volume") continue;
      EXPECT_NEAR(error.largest, 1 - height, 1e-12);
    }
    ASSERT_FALSE(world.step().notFinite.has_value());
  }
}

TEST(Cloth, LiesAboutItsMiddleWithItsFrontUp) {
  World world;
  ClothDef def = clothOf(3, 3);
  def.position = Vec3(1, 2, 3);
  const SoftParts parts = add(world, def);
  EXPECT_LT((placeOf(world, parts.nodes[0]) - Vec3(0, 2, 2.5)).norm(), 1e-15);
  EXPECT_LT((placeOf(world, parts.nodes[4]) - def.position).norm(), 1e-15);
  double area = 0;
  for (const auto& [a, b, c] : parts.triangles) {
    const Vec3 p = placeOf(world, parts.nodes[a]);
    const Vec3 normal =
        (placeOf(world, parts.nodes[b]) - p).cross(placeOf(world, parts.nodes[c]) - p) / 2;
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
    EXPECT_NEAR(placeOf(world, node).y(), -0.5, 1e-14);
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
