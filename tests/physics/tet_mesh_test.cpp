// Grids of tetrahedra fill their box, their skins are closed, and senseless meshes are refused.
#include "physics/make/tet_mesh.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "physics/base/rotation.h"
#include "physics/make/tet_fill.h"
#include "tests/physics/not_a_number.h"

namespace physics::testing {
namespace {

TetMesh oneTet() {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}, {{0, 1, 2, 3}}};
}

class BoxMesh : public ::testing::TestWithParam<std::array<int, 3>> {};

TEST_P(BoxMesh, HasFiveTetrahedraToACellThatFillTheBox) {
  const auto [x, y, z] = GetParam();
  const TetMesh mesh = boxMesh(Vec3(1, 2, 3), GetParam());
  EXPECT_EQ(mesh.nodes.size(), static_cast<size_t>((x + 1) * (y + 1) * (z + 1)));
  EXPECT_EQ(mesh.tets.size(), static_cast<size_t>(5 * x * y * z));
  EXPECT_NEAR(volumeOf(mesh), 6, 1e-12);
}

TEST_P(BoxMesh, HasPositiveTetrahedraOnly) {
  const TetMesh mesh = boxMesh(Vec3(1, 2, 3), GetParam());
  for (const auto& tet : mesh.tets) EXPECT_GT(volumeOf(mesh, tet), 0);
}

// Every edge of a closed skin belongs to two triangles that walk it in opposite directions.
TEST_P(BoxMesh, HasAClosedSkinThatLooksOutward) {
  const TetMesh mesh = boxMesh(Vec3(1, 2, 3), GetParam());
  const auto skin = skinOf(mesh);
  std::map<std::array<int, 2>, int> walked;
  double volume = 0, area = 0;
  for (const auto& [a, b, c] : skin) {
    for (const auto& edge : {std::array{a, b}, {b, c}, {c, a}}) ++walked[edge];
    const Vec3 &p = mesh.nodes[a], &q = mesh.nodes[b], &r = mesh.nodes[c];
    volume += p.cross(q).dot(r) / 6;
    area += (q - p).cross(r - p).norm() / 2;
  }
  for (const auto& [edge, count] : walked) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(walked.count({edge[1], edge[0]}), 1u);
  }
  EXPECT_NEAR(volume, 6, 1e-12);  // by Gauss, positive where the skin looks outward
  EXPECT_NEAR(area, 22, 1e-12);
  EXPECT_EQ(edgesOf(skin).size() * 2, skin.size() * 3);
}

INSTANTIATE_TEST_SUITE_P(Cells, BoxMesh,
                         ::testing::Values(std::array{1, 1, 1}, std::array{2, 1, 3},
                                           std::array{3, 4, 5}));

// Euler: nodes - edges + faces - tetrahedra = 1 for a ball.
TEST(TetMesh, CountsItsEdgesOnce) {
  const TetMesh mesh = boxMesh(Vec3::Ones(), {3, 4, 5});
  const auto skin = static_cast<int>(skinOf(mesh).size());
  const auto tets = static_cast<int>(mesh.tets.size());
  const int faces = (4 * tets + skin) / 2;
  const int edges = static_cast<int>(mesh.nodes.size()) + faces - tets - 1;
  EXPECT_EQ(static_cast<int>(edgesOf(mesh).size()), edges);
}

TEST(TetMesh, TurnsInvertedTetrahedraOver) {
  TetMesh mesh = oneTet();
  std::swap(mesh.tets[0][0], mesh.tets[0][1]);
  EXPECT_NEAR(volumeOf(mesh), -1.0 / 6, 1e-15);
  EXPECT_EQ(orient(mesh), 1);
  EXPECT_NEAR(volumeOf(mesh), 1.0 / 6, 1e-15);
  EXPECT_EQ(orient(mesh), 0);
}

std::string meshRefusal(const std::function<void(TetMesh&)>& spoil) {
  TetMesh mesh = oneTet();
  spoil(mesh);
  try {
    orient(mesh);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(TetMesh, RefusesWhatIsNoSolid) {
  EXPECT_EQ(meshRefusal([](TetMesh&) {}), "no error");
  EXPECT_EQ(meshRefusal([](TetMesh& m) { m.tets.clear(); }), "expected at least one tetrahedron");
  EXPECT_EQ(meshRefusal([](TetMesh& m) { m.tets[0][2] = 4; }),
            "tetrahedron 1: expected vertices in [1, 4], got 5");
  EXPECT_EQ(meshRefusal([](TetMesh& m) { m.tets[0][2] = -1; }),
            "tetrahedron 1: expected vertices in [1, 4], got 0");
  EXPECT_EQ(meshRefusal([](TetMesh& m) { m.nodes[3].z() = 1e-12; }),
            "tetrahedron 1 is flat: it has no volume");
  EXPECT_EQ(meshRefusal([](TetMesh& m) {
              m.tets.push_back({0, 1, 1, 2});
            }),
            "tetrahedron 2 is flat: it has no volume");
  EXPECT_EQ(meshRefusal([](TetMesh& m) { m.nodes[1].x() = kNaN; }), "vertex 2 is not finite");
  EXPECT_EQ(meshRefusal([](TetMesh& m) { m.nodes.emplace_back(1, 1, 1); }),
            "vertex 5 belongs to no tetrahedron, so that it has no mass");
  EXPECT_EQ(meshRefusal([](TetMesh& m) { m.tets.assign(3, m.tets[0]); }),
            "expected at most two tetrahedra on a face, got more on 1 2 3");
}

TEST(TetMesh, RefusesABoxWithoutSizeOrCells) {
  EXPECT_THROW(boxMesh(Vec3(1, 0, 1), {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(boxMesh(Vec3(1, kNaN, 1), {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW(boxMesh(Vec3::Ones(), {1, 0, 1}), std::invalid_argument);
}

// A cube of 12 triangles.
struct Surface {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
};
Surface cube() {
  Surface surface;
  for (int i = 0; i < 8; ++i) surface.vertices.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  const int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& [a, b, c, d] : sides) {
    surface.triangles.push_back({a, b, c});
    surface.triangles.push_back({a, c, d});
  }
  return surface;
}

TEST(FillMesh, OfACubeIsTheCube) {
  const Surface surface = cube();
  const TetMesh mesh = fillMesh(surface.vertices, surface.triangles, 4);
  EXPECT_NEAR(volumeOf(mesh), 1, 1e-12);
  EXPECT_EQ(mesh.tets.size(), 5u * 64);
}

// A smaller cube inside of it, inside out: a line along x goes in, out, in and out.
TEST(FillMesh, LeavesACavityEmpty) {
  Surface surface = cube();
  for (const Vec3& p : cube().vertices) surface.vertices.push_back(0.5 * p + Vec3::Constant(0.25));
  for (const auto& [a, b, c] : cube().triangles) surface.triangles.push_back({a + 8, c + 8, b + 8});
  EXPECT_NEAR(volumeOf(fillMesh(surface.vertices, surface.triangles, 8)), 1 - 0.125, 1e-12);
}

TEST(FillMesh, RefusesMorePointsThanASceneHoldsBodies) {
  const Surface surface = cube();
  EXPECT_THROW(fillMesh(surface.vertices, surface.triangles, 100), std::invalid_argument);
}

// Turned against the grid its corners are cut, and its faces drawn to.
TEST(FillMesh, OfATurnedCubeHasNearlyItsVolumeAndNoFlatTetrahedra) {
  Surface surface = cube();
  const Quat turn(Eigen::AngleAxisd(0.6, Vec3(1, 2, 0.5).normalized()));
  for (Vec3& p : surface.vertices) p = turn * p;
  TetMesh mesh = fillMesh(surface.vertices, surface.triangles, 10);
  EXPECT_EQ(orient(mesh), 0);
  EXPECT_NEAR(volumeOf(mesh), 1, 0.06);
  Eigen::AlignedBox3d bounds;
  for (const Vec3& p : surface.vertices) bounds.extend(p);
  const double cell = bounds.sizes().maxCoeff() / 10;
  int inside = 0, outside = 0;
  for (const auto& triangle : skinOf(mesh)) {
    for (const int corner : triangle) {
      const Vec3 p = turn.conjugate() * mesh.nodes[corner];
      const double off = (p - Vec3::Constant(0.5)).cwiseAbs().maxCoeff() - 0.5;
      EXPECT_LT(off, 0.5 * cell);  // where its tetrahedra would be flat it stays aside
      inside += off < -0.02 ? 1 : 0;
      outside += off > 1e-9 ? 1 : 0;
    }
  }
  const int corners = 3 * static_cast<int>(skinOf(mesh).size());
  EXPECT_LT(inside, corners / 15);
  EXPECT_LT(outside, corners / 6);
}

TEST(FillMesh, RefusesASurfaceThatIsOpenOrInsideOut) {
  Surface surface = cube();
  surface.triangles.pop_back();
  EXPECT_THROW(fillMesh(surface.vertices, surface.triangles, 4), std::invalid_argument);
  surface = cube();
  for (auto& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_THROW(fillMesh(surface.vertices, surface.triangles, 4), std::invalid_argument);
}

TEST(BallMesh, HasTheVolumeOfABallAsItsCellsGetSmall) {
  const double ball = 4 * kPi / 3 * 0.125;
  TetMesh mesh = ballMesh(0.5, 8);
  EXPECT_EQ(orient(mesh), 0);
  EXPECT_NEAR(volumeOf(mesh) / ball, 1, 0.04);
  EXPECT_LT(std::abs(volumeOf(ballMesh(0.5, 16)) / ball - 1),
            0.3 * std::abs(volumeOf(mesh) / ball - 1));
  for (const auto& triangle : skinOf(mesh)) {
    for (const int corner : triangle) EXPECT_NEAR(mesh.nodes[corner].norm(), 0.5, 1e-12);
  }
}

}  // namespace
}  // namespace physics::testing
