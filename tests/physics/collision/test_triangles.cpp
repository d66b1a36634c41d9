// Triangles: which directions are theirs, and what a mesh of them makes of a solid.
#include <gtest/gtest.h>

#include "physics/bodies/triangles.h"
#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using namespace testing;

// A field of cells x cells squares of 1 m about the origin, of this height at x and z.
template <class F>
Triangles field(int cells, F&& height) {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = i - 0.5 * cells, z = j - 0.5 * cells;
      vertices.emplace_back(x, height(x, z), z);
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      triangles.push_back({a, c, d});
      triangles.push_back({a, d, b});
    }
  }
  return {makeTriangleMesh(vertices, triangles)};
}
Triangles flat(int cells) {
  return field(cells, [](double, double) { return 0.0; });
}

std::vector<Shape> solids() {
  return {Sphere{0.3}, Capsule{0.2, 0.5}, Cylinder{0.25, 0.5}, Box{Vec3(0.5, 0.4, 0.6)}, wedge()};
}

TEST(TriangleMesh, KnowsNeighboursAndWeldsCorners) {
  const std::vector<Vec3> corners = {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0),
                                     Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 1)};
  const std::vector<std::array<int, 3>> triangles = {{0, 1, 2}, {3, 4, 5}, {0, 0, 1}};
  const auto mesh = makeTriangleMesh(corners, triangles);
  ASSERT_EQ(mesh->faces.size(), 2u);  // the third has no area
  EXPECT_EQ(mesh->faces[0].neighbours, (std::array<int, 3>{-1, 1, -1}));
  EXPECT_EQ(mesh->faces[1].neighbours, (std::array<int, 3>{0, -1, -1}));
  EXPECT_NEAR((mesh->faces[0].normal - Vec3(0, 1, 0)).norm(), 0, 1e-15);
}

TEST(TriangleMesh, RefusesWhatIsNone) {
  const std::vector<Vec3> corners = {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
  using Faces = std::vector<std::array<int, 3>>;
  EXPECT_THROW(makeTriangleMesh(corners, Faces{}), std::invalid_argument);
  EXPECT_THROW(makeTriangleMesh(corners, Faces{{0, 1, 3}}), std::invalid_argument);
  EXPECT_THROW(makeTriangleMesh(corners, Faces{{0, 1, 1}}), std::invalid_argument);
}

// Wherever a solid lies over the edges of a flat mesh, at whatever depth: one manifold, straight
// up, with the distance to the plane.
TEST(TriangleCollision, AFlatMeshIsThePlaneItLiesIn) {
  const Triangles ground = flat(8);
  Random random(7);
  for (const Shape& shape : solids()) {
    for (int i = 0; i < 300; ++i) {
      Pose pose{Vec3{random.number(-2, 2), 0, random.number(-2, 2)}, random.rotation()};
      if (i % 3 == 0) pose.q = turned(Vec3(0, 1, 0), random.number(0, 90));
      if (i % 6 == 0) pose.x.x() = std::round(pose.x.x());  // just over an edge
      const double low = supportOf(shape, pose, Vec3(0, -1, 0)).y();
      const double gap = i % 2 == 0 ? random.number(0, 0.02) : random.number(-0.1, 0);
      pose.x.y() = gap - low;
      const std::vector<Manifold> found = meet(shape, pose, ground, Pose{}, 0.05);
      ASSERT_EQ(found.size(), 1u) << shape.index() << " " << i;
      const std::vector<Pose> poses = {Pose{}, pose, Pose{}};
      EXPECT_NEAR((found[0].normal - Vec3(0, 1, 0)).norm(), 0, 1e-12);
      EXPECT_NEAR(smallestGap(found[0], poses), gap, 1.5e-3) << shape.index() << " " << i;
      const std::size_t points = meet(shape, pose, Plane{Vec3(0, 1, 0), 0}, Pose{}, 0.05)[0].count;
      EXPECT_GE(found[0].count + 1, static_cast<int>(points)) << shape.index() << " " << i;
    }
  }
}

// A box that stands in the corner of a floor and a wall touches both, and nothing between.
TEST(TriangleCollision, AHollowEdgeGivesTheTwoNormals) {
  const Triangles ground = field(
      8, [](double x, double) { return x > 0.5 ? x - 0.5 : 0.0; });  // 45 degrees from x = 1/2
  // Heights are linear between x = 0 and x = 1: a slope of 1/2 there, of 1 beyond.
  const Pose pose{Vec3(-0.21, 0.2, 0.3), Quat::Identity()};
  const std::vector<Manifold> found = meet(Box{Vec3(0.4, 0.4, 0.4)}, pose, ground, Pose{}, 0.02);
  for (const Manifold& manifold : found) {
    const bool floor = (manifold.normal - Vec3(0, 1, 0)).norm() < 1e-9;
    const bool slope = (manifold.normal - Vec3(-0.5, 1, 0).normalized()).norm() < 1e-9;
    EXPECT_TRUE(floor || slope) << manifold.normal.transpose();
  }
  ASSERT_GE(found.size(), 1u);
}

// A ridge pushes along all directions between its two sides.
TEST(TriangleCollision, ABallOnARidgeIsPushedFromTheEdge) {
  const Triangles ground = field(4, [](double x, double) { return -std::abs(x); });
  const Pose pose{Vec3(0.05, 0.29, 0.25), Quat::Identity()};
  const std::vector<Manifold> found = meet(Sphere{0.3}, pose, ground, Pose{}, 0.02);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR((found[0].normal - Vec3(0.05, 0.29, 0).normalized()).norm(), 0, 1e-9);
}

// Beside the faces of both, where their normals are less than the tolerance of directions apart.
TEST(TriangleCollision, ABallOverAnEdgeThatIsAllButFlatTouches) {
  constexpr double kSlope = 0.005;
  const Triangles ground = field(4, [](double x, double) { return -kSlope * std::abs(x); });
  for (const double x : {0.0, 0.0005, -0.001, 0.0014}) {
    const Pose pose{Vec3(x, 0.29, 0.25), Quat::Identity()};
    ASSERT_LT(std::abs(x), 0.29 * kSlope);
    const std::vector<Manifold> found = meet(Sphere{0.3}, pose, ground, Pose{}, 0.02);
    ASSERT_EQ(found.size(), 1u) << x;
    const std::vector<Pose> poses = {Pose{}, pose, Pose{}};
    EXPECT_NEAR(smallestGap(found[0], poses), std::hypot(x, 0.29) - 0.3, 1e-9) << x;
  }
}

TEST(TriangleCollision, IsSolidBelowAndOpenFromBelow) {
  const Triangles ground = flat(4);
  const auto meets = [&](double y) {
    return meet(Sphere{0.3}, {Vec3(0.2, y, 0.1), Quat::Identity()}, ground, Pose{}, 0.02).size();
  };
  EXPECT_EQ(meets(0.31), 1u);
  EXPECT_EQ(meets(-0.2), 1u);   // pushed out upwards
  EXPECT_EQ(meets(-0.31), 0u);  // wholly below
  EXPECT_EQ(meets(0.35), 0u);
}

// Through thin air in one step: what is met on the way, whatever the speed.
TEST(TriangleCollision, NothingPassesThroughAtAnySpeed) {
  const Triangles ground =
      field(12, [](double x, double z) { return 0.3 * std::sin(x) * std::cos(z); });
  Random random(3);
  for (const Shape& shape : solids()) {
    for (int i = 0; i < 60; ++i) {
      Collider collider;
      collider.add(1, shape, true);
      collider.add(2, ground, false);
      std::vector<Pose> start(3), end(3);
      start[1] = {Vec3{random.number(-2, 2), 2.5, random.number(-2, 2)}, random.rotation()};
      end[1] = {Vec3{random.number(-2, 2), -random.number(1.5, 40), random.number(-2, 2)},
                start[1].q};
      const auto found = collider.find(start, end, 0.01);
      ASSERT_GE(found.size(), 1u) << shape.index() << " " << i;
      double deepest = 0;
      for (const Manifold& manifold : found) {
        deepest = std::min(deepest, smallestGap(manifold, end));
      }
      EXPECT_LT(deepest, -0.3) << shape.index() << " " << i;
    }
  }
}

TEST(TriangleCollision, DistanceIsThatOfTheNearest) {
  const Triangles ground = flat(4);
  EXPECT_NEAR(distanceOf(Sphere{0.3}, {Vec3(0.1, 1, 0.2), Quat::Identity()}, ground, Pose{}), 0.7,
              1e-12);
  EXPECT_NEAR(distanceOf(Box{Vec3(1, 1, 1)}, {Vec3(3.5, 0, 0), Quat::Identity()}, ground, Pose{}),
              1, 1e-12);
}

}  // namespace
}  // namespace physics
