// Meshes of triangles that stand still: who is whose neighbour, and how sharp their edges are.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "physics/bodies/shape.h"

namespace physics {

// Counter-clockwise seen from outside.
struct TriangleMesh {
  struct Face {
    std::array<int, 3> vertices{};
    // By edge k, from vertex k to the next: the triangle across, or -1 where it is open.
    std::array<int, 3> neighbours{-1, -1, -1};
    Vec3 normal = Vec3::UnitY();
  };
  std::vector<Vec3> vertices;
  std::vector<Face> faces;
};

// Vertices that coincide are made one. Triangles without an area are left out. Throws
// std::invalid_argument where none is left, an index is out of range or a number is not finite.
std::shared_ptr<const TriangleMesh> makeTriangleMesh(std::span<const Vec3> vertices,
                                                     std::span<const std::array<int, 3>> triangles);

}  // namespace physics
