// A convex solid against one triangle of a mesh. Only the side that its corners are seen
// counter-clockwise from is solid, and an edge pushes only where its neighbour would not: what
// slides over a flat mesh does not feel the edges within.
#pragma once

#include <optional>

#include "physics/bodies/triangles.h"
#include "physics/collision/collider.h"
#include "physics/collision/solid.h"
#include "physics/collision/sweep.h"

namespace physics::collision {

// A triangle as a flat solid of its own, about its middle.
struct Triangle {
  Solid solid;
  Vec3 centre = Vec3::Zero();  // frame of the mesh
  Vec3 normal = Vec3::UnitY();
  const TriangleMesh* mesh = nullptr;
  int face = 0;

  Triangle();
  Triangle(const Triangle&) = delete;
  Triangle& operator=(const Triangle&) = delete;
  void set(const TriangleMesh& from, int index);  // allocates nothing

 private:
  std::shared_ptr<Hull> hull_;  // the solid's
};

// As touch(), with `pose` of a in the frame of the mesh, which `out` is in as well.
double touchTriangle(const Solid& a, const Triangle& triangle, const Relative& pose, double reach,
                     double keep, Manifold& out);

// As firstTouch(); of what is in front of the triangle at the start.
std::optional<double> firstTouch(const Solid& a, const Way& wayA, const Triangle& triangle,
                                 const Way& wayOfMesh, double near, int& calls);

}  // namespace physics::collision
