// Round bodies as triangles: how far off they are, and that none is wasted.
#include "render/geometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace render {
namespace {

Vec3f cornerOf(const Geometry& geometry, std::size_t index) {
  const std::array<float, 4>& p = geometry.vertices[geometry.indices[index]].position;
  return {p[0], p[1] + p[3], p[2]};
}

class Round : public ::testing::TestWithParam<Geometry (*)(int)> {};

TEST_P(Round, NoTriangleIsWithoutArea) {
  const Geometry geometry = GetParam()(16);
  for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
    const Vec3f a = cornerOf(geometry, i), b = cornerOf(geometry, i + 1),
                c = cornerOf(geometry, i + 2);
    EXPECT_GT((b - a).cross(c - a).norm(), 1e-3f) << i / 3;
  }
}

TEST_P(Round, TrianglesAreCounterclockwiseFromOutside) {
  const Geometry geometry = GetParam()(12);
  for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
    const Vec3f a = cornerOf(geometry, i), b = cornerOf(geometry, i + 1),
                c = cornerOf(geometry, i + 2);
    EXPECT_GT((b - a).cross(c - a).dot(a + b + c), 0) << i / 3;
  }
}

// Around the axis: a corner outside the circle, an edge's middle within it, by the same.
TEST_P(Round, AnOutlineIsOffByAsMuchToEitherSide) {
  for (const int segments : {8, 20, 64}) {
    double outside = 0;
    for (const Vertex& vertex : GetParam()(segments).vertices)
      outside = std::max(outside, std::hypot(vertex.position[0], vertex.position[2]) - 0.5);
    const double within = 0.5 - (0.5 + outside) * std::cos(M_PI / segments);
    EXPECT_NEAR(outside, within, 1e-6) << segments;
    EXPECT_LT(outside, 0.5 * 2.6 / (segments * segments)) << segments;
  }
}

INSTANTIATE_TEST_SUITE_P(Geometries, Round,
                         ::testing::Values(&unitSphere, &unitCapsule, &unitCylinder));

}  // namespace
}  // namespace render
