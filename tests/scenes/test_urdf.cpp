// URDF, feature by feature.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "scenes/models/mesh_points.h"
#include "tests/scenes/model_text.h"

namespace scenes {
namespace {

using physics::Vec3;

std::string robot(const std::string& inside) {
  return "<robot name='r'>\n" + inside + "\n</robot>\n";
}

std::string link(const std::string& name, const std::string& inside) {
  return "<link name='" + name + "'>" + inside + "</link>\n";
}

const std::string kMass =
    "<inertial><mass value='2'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/>"
    "</inertial>";
const std::string kBox = "<collision><geometry><box size='1 2 3'/></geometry></collision>";

std::string joint(const std::string& type, const std::string& inside) {
  return "<joint name='j' type='" + type + "'><parent link='a'/><child link='b'/>" + inside +
         "</joint>\n";
}

TEST(Urdf, StandsOnALinkWithoutAMassAndTurnsAboutItsJoint) {
  Simulation s(modelOf(robot(link("a", "") + link("b", kBox + kMass) +
                             joint("continuous", "<origin xyz='0 0 1'/><axis xyz='0 1 0'/>"))));
  EXPECT_NEAR((poseOf(s, "b").x - yUp(0, 0, 1)).norm(), 0, 1e-12);
  for (int k = 0; k < 60; ++k) s.advance();
  EXPECT_NEAR((poseOf(s, "b").x - yUp(0, 0, 1)).norm(), 0, 1e-6);  // its centre is on the axis
}

TEST(Urdf, FallsWithALinkThatHasOne) {
  Simulation s(modelOf(robot(link("a", kBox + kMass))));
  for (int k = 0; k < 60; ++k) s.advance();
  EXPECT_NEAR(poseOf(s, "a").x.y(), -9.81 / 2, 0.1);
}

TEST(Urdf, TurnsByRollPitchAndYawAboutAxesThatStay) {
  const Simulation s(
      modelOf(robot(link("a", "") + link("b", kBox + kMass) +
                    joint("revolute",
                          "<origin rpy='1.5707963267948966 0 1.5707963267948966'/><limit lower='-1'"
                          " upper='1' effort='5' velocity='1'/>"))));
  // z goes by roll to -y, and that by yaw to x.
  EXPECT_NEAR((poseOf(s, "b").q * Vec3::UnitZ() - yUp(1, 0, 0)).norm(), 0, 1e-12);
}

TEST(Urdf, KeepsASlideWithinItsLimits) {
  Simulation s(modelOf(robot(link("a", "") + link("b", kBox + kMass) +
                             joint("prismatic",
                                   "<axis xyz='0 0 1'/><limit lower='-.25' upper='.5'"
                                   " effort='1' velocity='1'/>"))));
  for (int k = 0; k < 120; ++k) s.advance();
  EXPECT_NEAR(poseOf(s, "b").x.y(), -0.25, 1e-4);
}

TEST(Urdf, TellsWhatItDoesNotRead) {
  const Scene scene = modelOf(
      robot(link("a", "<visual><geometry><mesh filename='a.dae'/></geometry></visual>") +
            link("b", kBox + kMass) + joint("continuous", "<mimic joint='k'/>") + "<gazebo/>"));
  const std::vector<std::string> expected = {"m.xml:2: not read: <mesh> of the kind '.dae'",
                                             "m.xml:4: not read: <mimic>",
                                             "m.xml:5: not read: <gazebo>"};
  EXPECT_EQ(scene.told, expected);
}

TEST(Urdf, RefusesWhatIsNoTree) {
  EXPECT_EQ(modelError(robot(link("a", "") + joint("fixed", ""))),
            "m.xml:3:49: <child>: no link 'b'");
  EXPECT_EQ(modelError(robot(link("a", "") + link("b", ""))),
            "m.xml:1:2: <robot>: expected one link that is no joint's child, got 2");
  EXPECT_EQ(modelError(robot(link("a", kMass + kBox) + link("a", ""))),
            "m.xml:3:2: <link>: a second link 'a'");
}

TEST(Urdf, ReadsMeshesOfAPackageInAFolderAbove) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "urdf_package";
  fs::create_directories(folder / "arm" / "meshes");
  fs::create_directories(folder / "arm" / "urdf");
  std::ofstream(folder / "arm/meshes/m.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string text =
      robot(link("a",
                 "<collision><geometry><mesh filename='package://arm/meshes/m.obj'"
                 " scale='1 1 3'/></geometry></collision>"));
  const Simulation s(parseScene(text, (folder / "arm/urdf/r.urdf").string()));
  EXPECT_NEAR(physics::massProperties(s.world().bodies().shape.back()).volume, 3.0 / 6, 1e-9);
}

TEST(MeshPoints, AreTheSameOfEachKindOfFile) {
  namespace fs = std::filesystem;
  const fs::path folder = testing::TempDir();
  std::ofstream(folder / "p.obj") << "# c\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n";
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::ofstream text(folder / "t.stl"), binary(folder / "b.stl", std::ios::binary);
  const std::uint32_t count = 4;
  binary << std::string(80, ' ');
  binary.write(reinterpret_cast<const char*>(&count), 4);
  text << "solid s\n";
  for (const auto& face : faces) {
    const float normal[3] = {0, 0, 0};
    binary.write(reinterpret_cast<const char*>(normal), 12);
    for (const int k : face) {
      binary.write(reinterpret_cast<const char*>(corners[k]), 12);
      text << "vertex " << corners[k][0] << ' ' << corners[k][1] << ' ' << corners[k][2] << '\n';
    }
    binary.write("\0\0", 2);
  }
  text.close();
  binary.close();
  const auto points = meshPoints((folder / "p.obj").string());
  EXPECT_EQ(points.size(), 4u);
  EXPECT_EQ(points, meshPoints((folder / "t.stl").string()));
  EXPECT_EQ(points, meshPoints((folder / "b.stl").string()));
}

}  // namespace
}  // namespace scenes
