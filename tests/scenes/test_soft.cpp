// Ropes, cloths and soft bodies of a scene file: their names, their looks, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/read/recipe.h"
#include "scenes/view/view.h"
#include "tests/scenes/picture_of.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

const std::string kRope = "[[rope]]\nfrom = [0, 2, 0]\nto = [1, 2, 0]\n";
const std::string kCloth = "[[cloth]]\nsize = [1, 1]\nnodes = [4, 3]\n";
const std::string kSoft = "[[soft_body]]\nbox = { size = [1, 1, 1], cells = [2, 2, 2] }\n";

TEST(SceneRope, NamesItsNodesAndItsEnd) {
  const Simulation simulation(sceneOf(kRope + "count = 7\n"));
  EXPECT_EQ(simulation.bodyName(7), "rope.6");
  EXPECT_EQ(simulation.findBody("rope.end"), simulation.findBody("rope.6"));
}

TEST(SceneRope, HangsABodyThatIsDefinedBelowIt) {
  const Simulation simulation(
      sceneOf(kRope + "pins = \"start\"\nattach = { end = \"a\" }\n" + ball("a")));
  EXPECT_EQ(simulation.world().joints().back().kind, "ball_socket");
}

TEST(SceneRope, IsSeenAsATubeWithoutItsPoints) {
  const render::Picture picture = pictureOf(kRope + "count = 7\nradius = 0.05\n");
  ASSERT_EQ(picture.instances.size(), 6u);
  for (const render::Instance& piece : picture.instances) {
    EXPECT_EQ(piece.primitive, render::Primitive::kCapsule);
    EXPECT_NEAR(piece.size.x(), 0.1, 1e-6);
    EXPECT_NEAR(piece.size.y(), 1.0 / 6, 1e-6);
  }
}

TEST(SceneCloth, NamesItsNodesByIndexAndByRowAndColumn) {
  const Simulation simulation(sceneOf(kCloth));
  EXPECT_EQ(simulation.bodyName(1 + 2 * 4 + 3), "cloth.11");
  EXPECT_EQ(simulation.findBody("cloth.3.2"), simulation.findBody("cloth.11"));
}

TEST(SceneCloth, IsSeenAsOneSurfaceWithAGridWithoutItsPoints) {
  const render::Picture picture = pictureOf(kCloth);
  EXPECT_TRUE(picture.instances.empty());
  ASSERT_EQ(picture.surfaces.size(), 1u);
  EXPECT_EQ(picture.surfaces[0].positions.size(), 12u);
  EXPECT_EQ(picture.surfaces[0].grid.size(), 12u);
  EXPECT_NE(picture.surfaces[0].color, picture.surfaces[0].backColor);
}

TEST(SceneCloth, IsSeenAsANetOnRequest) {
  const render::Picture picture = pictureOf(kCloth + "draw = \"net\"\n");
  EXPECT_TRUE(picture.surfaces.empty());
  EXPECT_EQ(picture.instances.size(), 12u + 3 * 3 + 4 * 2);
}

TEST(SceneCloth, ReadsItsPinsAsAWordOrAsNodes) {
  const auto fixed = [](const std::string& pins) {
    const Simulation simulation(sceneOf(kCloth + "pins = " + pins + "\n"));
    const auto& motion = simulation.world().bodies().motion;
    return std::count(motion.begin() + 1, motion.end(), physics::Motion::kStatic);
  };
  EXPECT_EQ(fixed("\"top_row\""), 4);
  EXPECT_EQ(fixed("[[0, 0], [3, 2], [1, 1]]"), 3);
}

TEST(SceneSoftBody, IsSeenByItsSkin) {
  const render::Picture picture = pictureOf(kSoft + "radius = 0.03\n");
  ASSERT_EQ(picture.surfaces.size(), 1u);
  EXPECT_EQ(picture.surfaces[0].positions.size(), 26u);  // 27 nodes, one inside
  EXPECT_EQ(picture.surfaces[0].indices.size(), 3u * 48);
  EXPECT_FLOAT_EQ(picture.surfaces[0].offset, 0.03f);
}

TEST(SceneSoftBody, ReadsTheMeshOfTheAssets) {
  const Simulation simulation(sceneOf("[[soft_body]]\nmesh = \"torus.mesh\"\n"));
  EXPECT_EQ(simulation.world().bodyCount(), 1 + 216);
}

TEST(SceneSoft, MovesTheBoundsOfTheMotion) {
  const Simulation simulation(sceneOf(kRope));
  MotionBounds bounds;
  bounds.include(simulation);
  EXPECT_NEAR(bounds.high.x() - bounds.low.x(), 1, 1e-12);
}

TEST(SceneSoft, RefusesWhatMakesNoSense) {
  const auto refuses = [](const std::string& text, const std::string& message) {
    EXPECT_EQ(errorOf(text), "test.toml:" + message);
  };
  refuses(kRope + "count = 1\n", "4:9: rope.count: expected an integer in [2, 100000], got 1");
  refuses(kRope + "length = -1\n", "4:10: rope.length: expected a number > 0 [m], got -1");
  refuses(kRope + "length = 0.5\n",
          "1:1: rope: expected a length of at least |to - from| = 1.000000 m, got 0.500000 m");
  refuses(kRope + "radius = 0\n", "4:10: rope.radius: expected a number > 0 [m], got 0");
  refuses(kRope + "direction = [1, 0, 0]\n",
          "4:13: rope.direction: expected 'to' or 'direction', not both");
  refuses(kRope + "bending_stiffness = -2\n",
          "4:21: rope.bending_stiffness: expected a number >= 0 [N/m], got -2");
  refuses(kRope + "pins = \"middle\"\n",
          "4:8: rope.pins: expected one of 'none', 'start', 'end', 'both', got 'middle'");
  refuses(kRope + "attach = { end = \"bal\" }\n" + ball("ball"),
          "4:18: rope.attach: no body 'bal'; did you mean 'ball'?");
  refuses(kRope + "mass = 1\nnode_mass = 1\n",
          "5:13: rope.node_mass: expected 'mass' or 'node_mass', not both");
  refuses(kRope + "drag = { coefficient = -1 }\n",
          "4:24: rope.drag.coefficient: expected a number >= 0, got -1");
}

TEST(SceneSoft, RefusesClothsThatMakeNoSense) {
  const auto refuses = [](const std::string& text, const std::string& message) {
    EXPECT_EQ(errorOf(text), "test.toml:" + message);
  };
  refuses("[[cloth]]\nsize = [1, 0]\nnodes = [4, 3]\n",
          "2:12: cloth.size: expected a number > 0 [m], got 0");
  refuses("[[cloth]]\nsize = [1, 1]\nnodes = [1, 3]\n",
          "3:10: cloth.nodes: expected an integer in [2, 100000], got 1");
  refuses("[[cloth]]\nsize = [1, 1]\nnodes = [1000, 1000]\n",
          "1:1: cloth: expected at most 100000 bodies, got 1000000");
  refuses(kCloth + "v = [2, 0, 0]\n", "1:1: cloth: expected 'u' and 'v' not to be parallel");
  refuses(kCloth + "edges = \"springs\"\nstiffness = -1\n",
          "5:13: cloth.stiffness: expected a number >= 0 [N/m], got -1");
  refuses(kCloth + "stiffness = 1\n", "4:13: cloth.stiffness: expected edges = 'springs' as well");
  refuses(kCloth + "compliance = -1\n", "4:14: cloth.compliance: expected a number >= 0, got -1");
  refuses(kCloth + "pins = [[4, 0]]\n",
          "1:1: cloth: expected a node of the grid of [4, 3], got [4, 0]");
  refuses(kCloth + "pins = [[0, -1]]\n", "4:13: cloth.pins: expected an integer >= 0, got -1");
  refuses(kCloth + "attach = [{ node = [0, 0], body = \"b\" }]\n",
          "4:35: cloth.attach: no body 'b'");
}

TEST(SceneSoft, RefusesSoftBodiesThatMakeNoSense) {
  const auto refuses = [](const std::string& text, const std::string& message) {
    EXPECT_EQ(errorOf(text), "test.toml:" + message);
  };
  refuses("[[soft_body]]\nname = \"s\"\n", "1:1: soft_body: expected 'box', 'ball' or 'mesh'");
  refuses("[[soft_body]]\nbox = { size = [1, 1, 0], cells = [1, 1, 1] }\n",
          "2:23: soft_body.box.size: expected a number > 0 [m], got 0");
  refuses("[[soft_body]]\nbox = { size = [1, 1, 1], cells = [1, 0, 1] }\n",
          "2:39: soft_body.box.cells: expected an integer in [1, 1000], got 0");
  refuses(kSoft + "bulk_modulus = 0\n",
          "3:16: soft_body.bulk_modulus: expected a number > 0, got 0");
  refuses(kSoft + "edges = \"links\"\nstiffness = 3\n",
          "4:13: soft_body.stiffness: expected edges = 'springs' as well");
  refuses(kSoft + "scale = 0\n", "3:9: soft_body.scale: expected a number > 0, got 0");
  refuses("[[soft_body]]\nmesh = \"tours.mesh\"\n",
          "2:8: soft_body.mesh: no mesh 'tours.mesh' beside the scene or in assets/meshes; did you "
          "mean 'torus.mesh'?");
}

}  // namespace
}  // namespace scenes
