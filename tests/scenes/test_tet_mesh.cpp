// Tetrahedral meshes from files: what is read, what is turned over, and what is refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

// Meshes that are written beside a scene of their own.
class SceneMesh : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() /
        ("dbd_mesh_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string error(const std::string& mesh) const {
    std::ofstream(folder_ / "a.mesh") << mesh;
    try {
      const Scene scene =
          parseScene("[[soft_body]]\nmesh = \"a.mesh\"\n", (folder_ / "test.toml").string());
      const int bodies = Simulation(scene).world().bodyCount();
      return "no error, " + std::to_string(bodies - 1) + " nodes";
    } catch (const InputError& error) {
      const std::string text = error.what();
      return text.substr(std::min(text.size(), folder_.string().size() + 1));
    }
  }
  static std::string file(const std::string& vertices, const std::string& tets) {
    return "MeshVersionFormatted 2\nDimension\n3\nVertices " + vertices + "\nTetrahedra " + tets +
           "\nEnd\n";
  }

  std::filesystem::path folder_;
  const std::string kFour = "4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1";
  const std::string kAt = "test.toml:2:8: soft_body.mesh: a.mesh: ";
};

TEST_F(SceneMesh, IsReadWithCommentsAndOtherSections) {
  EXPECT_EQ(error(file("# corners\n" + kFour + "\nTriangles 1\n1 2 3 7", "1 1 2 3 4 9")),
            "no error, 4 nodes");
}

TEST_F(SceneMesh, IsTurnedOverWhereItIsInverted) {
  EXPECT_EQ(error(file(kFour, "1\n2 1 3 4 0")), "no error, 4 nodes");
}

TEST_F(SceneMesh, IsRefusedWhereItIsNoSolid) {
  EXPECT_EQ(error(""), kAt + "expected a section 'Vertices', got none");
  EXPECT_EQ(error("Vertices " + kFour), kAt + "expected a section 'Tetrahedra', got none");
  EXPECT_EQ(error(file("0", "0")), kAt + "line 4: expected the number of vertices, got 0");
  EXPECT_EQ(error(file(kFour, "1\n1 2 3 5 0")),
            kAt + "tetrahedron 1: expected vertices in [1, 4], got 5");
  EXPECT_EQ(error(file(kFour, "1\n1 2 3 0 0")),
            kAt + "line 10: expected the number of a vertex, from 1, got 0");
  EXPECT_EQ(error(file(kFour, "2\n1 2 3 4 0\n1 2 3 3 0")),
            kAt + "tetrahedron 2 is flat: it has no volume");
  EXPECT_EQ(error(file("4\n0 0 nan 1", "1")),
            kAt + "line 5: expected a finite coordinate of a vertex, got 'nan'");
  EXPECT_EQ(error(file("4\n0 0 x 1", "1")),
            kAt + "line 5: expected a finite coordinate of a vertex, got 'x'");
  EXPECT_EQ(error("Vertices 4\n0 0 0 1\n"),
            kAt + "line 2: expected a finite coordinate of a vertex, got the end of the file");
  EXPECT_EQ(error("Dimension 2\n" + file(kFour, "1\n1 2 3 4 0")),
            kAt + "line 1: expected a mesh of dimension 3");
  EXPECT_EQ(error(file("5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 1 1 1", "1\n1 2 3 4 0")),
            kAt + "vertex 5 belongs to no tetrahedron, so that it has no mass");
}

TEST(SoftSolid, IsFilledFromAClosedObjFile) {
  const Simulation simulation(
      sceneOf("[[soft_body]]\nname = \"s\"\nmesh = { obj = \"pear.obj\", cells = 6 }\n"));
  const physics::Bodies& b = simulation.world().bodies();
  double mass = 0;
  for (const double m : b.mass) mass += m;
  EXPECT_NEAR(mass, 1000 * 0.3127, 30);  // of water, by the surface's own volume
  EXPECT_EQ(errorOf("[[soft_body]]\nmesh = { obj = \"gem.obj\" }\n"),
            "test.toml:2:16: soft_body.mesh.obj: gem.obj: triangles: at least one with an area is "
            "needed");
}

}  // namespace
}  // namespace scenes
