// Triangles of the unit primitives, with what the shader needs to scale them and draw their edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/picture.h"

namespace render {

struct Vertex {
  std::array<float, 4> position;  // w: +1 or -1 moves with the upper or lower end of a capsule
  std::array<float, 3> normal;
  std::array<float, 2> edge;  // reaches +-1 at an edge of the face; 0 where there is none
};

struct Geometry {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counterclockwise from outside
};

Geometry unitBox();

// The half of a ball or a capsule that faces the viewer, whom the shader knows: kFacingVertex.
// Meridians run from pole to pole, which lie at both sides of what the viewer sees; the last is the
// outline, of `segments` / 2 pieces, the first the end of the tube. Vertex::position is the end (+1
// or -1), cosine and sine along the meridian and how far out; Vertex::normal how much of the first,
// the middle and the last meridian is in its own.
Geometry facingBall(int segments);
Geometry facingCapsule(int segments);

// Round ones have `segments` around, a multiple of four; their corners are as far outside the true
// surface as the middles of the edges around are within it.
Geometry unitSphere(int segments);    // diameter 1
Geometry unitCapsule(int segments);   // diameter 1, ends apart by Vertex::position[3]
Geometry unitCylinder(int segments);  // diameter 1, length 1 along y
// Throws std::invalid_argument when counts differ or an index is out of range.
Geometry geometryOf(const Mesh& mesh);

// One unit normal per position: the sum over its triangles, weighed by their areas. Up where that
// is zero.
std::vector<Vec3f> smoothNormals(const std::vector<Vec3f>& positions,
                                 const std::vector<std::uint32_t>& triangles);

// One per corner of a triangle: the same sum over the triangles of the position that face within
// 60 degrees of the corner's own.
std::vector<Vec3f> creasedNormals(const std::vector<Vec3f>& positions,
                                  const std::vector<std::uint32_t>& triangles);

}  // namespace render
