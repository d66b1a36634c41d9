// Bodies of several shapes, ground of triangles, welds and velocities, as scene files say them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "physics/bodies/compound.h"
#include "physics/bodies/triangles.h"
#include "scenes/read/recipe.h"
#include "scenes/simulation.h"
#include "scenes/view/view.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

using physics::Vec3;

// Two balls, 3 kg and 1 kg, 1 m apart along x: the centre of mass is 0.25 m from the first.
const char* const kDumbbell = R"(
[[body]]
name = "bell"
position = [1, 2, 3]
rotation = { axis = [0, 0, 1], degrees = 90 }
shapes = [
  { shape = { sphere = { radius = 0.2 } }, mass = 3, color = "#cc3333" },
  { shape = { sphere = { radius = 0.1 } }, position = [1, 0, 0], mass = 1 },
]
)";

TEST(SceneShapes, SumMassesAndStayWhereTheFileHasThem) {
  const Simulation simulation(sceneOf(kDumbbell));
  const physics::Bodies& b = simulation.world().bodies();
  EXPECT_DOUBLE_EQ(b.mass[1], 4);
  EXPECT_NEAR((b.pose[1].x - Vec3(1, 2.25, 3)).norm(), 0, 1e-12);
  const auto& parts = std::get<physics::Compound>(b.shape[1]).parts->list;
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR((physics::placed(b.pose[1], parts[1].pose).x - Vec3(1, 3, 3)).norm(), 0, 1e-12);
}

TEST(SceneShapes, TakeAMassForAllOfThem) {
  const Simulation simulation(sceneOf(std::string(kDumbbell) + "mass = 8\n"));
  EXPECT_DOUBLE_EQ(simulation.world().bodies().mass[1], 8);
  EXPECT_NEAR(simulation.world().bodies().pose[1].x.y(), 2.25, 1e-12);
}

// As it is weighed, not as its shapes would weigh.
TEST(SceneShapes, TakeTheInertiaThatIsStated) {
  const std::string stated =
      "mass = 5\ninertia = [1, 2, 2.5]\ncentre_of_mass = [0.5, 0, 0]\n"
      "inertia_axes = { axis = [0, 0, 1], degrees = 90 }\n";
  const Simulation simulation(sceneOf(kDumbbell + stated));
  const physics::Bodies& b = simulation.world().bodies();
  EXPECT_NEAR((b.pose[1].x - Vec3(1, 2.5, 3)).norm(), 0, 1e-12);
  EXPECT_DOUBLE_EQ(b.mass[1], 5);
  const auto& parts = std::get<physics::Compound>(b.shape[1]).parts->list;
  EXPECT_NEAR((physics::placed(b.pose[1], parts[1].pose).x - Vec3(1, 3, 3)).norm(), 0, 1e-12);
  // Of 1 kg m^2 about the axis that the body's x is turned to by 90 degrees twice: the world's -x.
  const Vec3 first = b.pose[1].q * Vec3::UnitX();
  EXPECT_NEAR(std::abs(first.x()), 1, 1e-12);
}

TEST(SceneShapes, WantAllOfAStatedInertia) {
  EXPECT_NE(errorOf(std::string(kDumbbell) + "centre_of_mass = [0, 0, 0]\n")
                .find("expected 'shapes', 'mass' and 'inertia' beside it"),
            std::string::npos);
  EXPECT_NE(
      errorOf(std::string(kDumbbell) + "inertia = [1, 1, 1]\n").find("expected 'mass' beside it"),
      std::string::npos);
}

// The anchor is in the frame that the file has of the body: the light ball's centre.
TEST(SceneShapes, AreJoinedInTheFrameOfTheFile) {
  const std::string joint =
      "[[ball_socket]]\nbodies = [\"world\", \"bell\"]\nanchors = [[1, 3, 3], [1, 0, 0]]\n";
  const Simulation simulation(sceneOf(kDumbbell + joint));
  const auto joints = simulation.world().joints();
  ASSERT_EQ(joints.size(), 1u);
  EXPECT_NEAR(joints[0].error, 0, 1e-12);
  EXPECT_NEAR((joints[0].pointB - Vec3(1, 3, 3)).norm(), 0, 1e-12);
}

TEST(SceneShapes, AreDrawnEachInItsColour) {
  const Simulation simulation(sceneOf(kDumbbell));
  MotionBounds bounds;
  bounds.include(simulation);
  const render::Picture picture = view(simulation, bounds, {}, {});
  ASSERT_EQ(picture.instances.size(), 2u);
  EXPECT_NE(picture.instances[0].color, picture.instances[1].color);
  EXPECT_NEAR((picture.instances[1].position - render::Vec3f(1, 3, 3)).norm(), 0, 1e-5);
}

TEST(SceneShapes, AreRefusedAtTheirPlace) {
  const auto error = [](const std::string& shapes) {
    return errorOf("[[body]]\nshapes = " + shapes + "\n");
  };
  EXPECT_EQ(error("[]"),
            "test.toml:2:10: body.shapes: expected an array of parts such as [{ shape = { sphere = "
            "{ radius = 1 } } }], got an array of 0");
  EXPECT_EQ(error("[{ shape = { plane = {} } }]"),
            "test.toml:2:21: body.shapes.shape: expected a part with a volume: a box, sphere, "
            "capsule, cylinder or convex");
  EXPECT_EQ(error("[{ position = [0, 0, 0] }]"),
            "test.toml:2:11: body.shapes: expected a value for 'shape'");
  EXPECT_EQ(error("[{ shape = { sphere = { radius = 1 } }, postion = [0, 0, 0] }]"),
            "test.toml:2:50: body.shapes: unknown key 'postion'; did you mean 'position'?");
  EXPECT_EQ(errorOf("[[body]]\nname = \"a\"\n"),
            "test.toml:1:1: body: expected 'shape' or 'shapes'");
}

TEST(SceneGround, OfHeightsIsAFormulaOrRows) {
  const Simulation formula(
      sceneOf("[[body]]\nshape = { heights = { size = [4, 2], cells = [8, 4], "
              "formula = \"0.5 * x + z\" } }\n"));
  const auto& mesh = *std::get<physics::Triangles>(formula.world().bodies().shape[1]).mesh;
  EXPECT_EQ(mesh.faces.size(), 64u);
  for (const Vec3& p : mesh.vertices) EXPECT_NEAR(p.y(), 0.5 * p.x() + p.z(), 1e-12);
  for (const auto& face : mesh.faces) EXPECT_GT(face.normal.y(), 0);
  const Simulation rows(sceneOf(
      "[[body]]\nshape = { heights = { size = [1, 1], rows = [[0, 1, 0], [2, 3, 2]] } }\n"));
  EXPECT_EQ(std::get<physics::Triangles>(rows.world().bodies().shape[1]).mesh->faces.size(), 4u);
}

TEST(SceneGround, IsRefusedAtItsPlace) {
  const auto error = [](const std::string& words) {
    return errorOf("[[body]]\nshape = { heights = { size = [1, 1], " + words + " } }\n");
  };
  EXPECT_EQ(error("formula = \"sin(y)\""),
            "test.toml:2:48: body.shape.heights.formula: unknown name 'y'; expected x or z");
  EXPECT_EQ(error("rows = [[0, 0], [0]]"),
            "test.toml:2:45: body.shape.heights.rows: expected 2 to 401 rows of one length, of 2 "
            "to 401 heights");
  EXPECT_EQ(error("cells = [4, 4]"),
            "test.toml:2:21: body.shape.heights: expected 'rows' or 'formula'");
  EXPECT_EQ(errorOf("[[body]]\nshape = { heights = { size = [1, 1], rows = [[0, 0], [0, 0]] } }\n"
                    "fixed = false\n"),
            "test.toml:3:9: body.fixed: expected true: ground of triangles does not move");
}

TEST(SceneGround, OfAnObjFileHasItsFaces) {
  const Simulation simulation(
      sceneOf("[[body]]\nshape = { triangles = { mesh = \"ramp.obj\" } }\n"));
  const auto& mesh = *std::get<physics::Triangles>(simulation.world().bodies().shape[1]).mesh;
  EXPECT_EQ(mesh.faces.size(), 12u);
  for (const auto& face : mesh.faces) {
    for (const int across : face.neighbours) EXPECT_GE(across, 0);  // it is closed
  }
}

TEST(SceneGround, TellsTheLineOfAFileThatIsWrong) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "dbd_wrong_face.obj";
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nf 1 2 7\n";
  const std::string error =
      errorOf("[[body]]\nshape = { triangles = { mesh = \"" + file.string() + "\" } }\n");
  EXPECT_NE(error.find("dbd_wrong_face.obj:3: expected 'f' and corners of the 2 vertices above"),
            std::string::npos)
      << error;
  std::filesystem::remove(file);
}

TEST(SceneWeld, JoinsAtTheMiddleWhereNoPlaceIsSaid) {
  const Simulation simulation(sceneOf(ball("a") + "position = [0, 0, 0]\n" + ball("b") +
                                      "position = [2, 0, 0]\n[[weld]]\nbodies = [\"a\", \"b\"]\n"));
  const auto joints = simulation.world().joints();
  ASSERT_EQ(joints.size(), 2u);
  const std::size_t point = joints[0].kind == physics::BallSocketDef::kWord ? 0 : 1;
  EXPECT_NEAR((joints[point].pointA - Vec3(1, 0, 0)).norm(), 0, 1e-12);
}

// A stack of two boxes thrown and spun as one.
TEST(SceneGenerator, GivesAVelocityToTheWhole) {
  const Simulation simulation(
      sceneOf("[[stack]]\nname = \"s\"\ncount = 2\nvelocity = [3, 0, 0]\n"
              "angular_velocity = [0, 0, 2]\nrestitution = 0.5\n"));
  const physics::Bodies& b = simulation.world().bodies();
  const Vec3 apart = b.pose[2].x - b.pose[1].x;
  EXPECT_NEAR((0.5 * (b.velocity[1].v + b.velocity[2].v) - Vec3(3, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((b.velocity[2].v - b.velocity[1].v - Vec3(0, 0, 2).cross(apart)).norm(), 0, 1e-12);
  EXPECT_EQ(b.restitution[1], 0.5);
}

TEST(SceneContact, IsAskedForByARestitution) {
  EXPECT_TRUE(sceneOf(ball("a") + "restitution = 0.5\n").settings.contact.has_value());
  EXPECT_EQ(errorOf(ball("a") + "restitution = 1.5\n"),
            "test.toml:4:15: body.restitution: expected a number in [0, 1], got 1.5");
}

}  // namespace
}  // namespace scenes
