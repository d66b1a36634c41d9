// Polyhedra: exact mass properties and faces from points.
#pragma once

#include <span>

#include "physics/bodies/shape.h"

namespace physics {

struct PolyhedronMass {
  double volume = 0;                   // m^3
  Vec3 centre = Vec3::Zero();          // m
  Mat3 inertiaPerMass = Mat3::Zero();  // about the centre of mass [m^2]
};

// Exact, by signed tetrahedra from the first vertex.
PolyhedronMass polyhedronMass(const Hull& hull);

// Columns are the principal axes of a tensor; the identity when the frame has them already (1e-9
// relative).
Mat3 principalAxes(const Mat3& inertia);

// The convex hull where the points are: coplanar facets merged, vertices in the order of the
// points. Throws std::invalid_argument for fewer than four points, points in one plane, or numbers
// that are not finite.
Hull convexHull(std::span<const Vec3> points);

// The box [-half, half], faces in the order -x +x -y +y -z +z, vertex i at the corner with bits xyz
// = 1 2 4.
Hull boxHull(const Vec3& half);

}  // namespace physics
