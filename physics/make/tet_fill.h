// Tetrahedra inside of a closed surface.
#pragma once

#include <span>

#include "physics/make/tet_mesh.h"

namespace physics {

// A grid of `cells` along the longest side of the surface's bounds, five tetrahedra to a cell:
// those whose middle is inside stay, and the corners of what stays are moved onto the surface as
// far as no tetrahedron loses most of its volume. Triangles are counter-clockwise seen from
// outside. Throws std::invalid_argument with the reason where the surface is not closed or nothing
// is inside.
TetMesh fillMesh(std::span<const Vec3> vertices, std::span<const std::array<int, 3>> triangles,
                 int cells);

// A ball about the origin, out of a cube of `cells` cells along each side.
TetMesh ballMesh(double radius, int cells);

}  // namespace physics
