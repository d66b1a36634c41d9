// A convex solid against a mesh of triangles: the manifolds of all that it is near, one for each
// direction.
#pragma once

#include <vector>

#include "physics/collision/collider.h"
#include "physics/collision/sweep.h"

namespace physics::collision {

// What is looked for.
struct MeshLook {
  Relative pose;               // of the solid in the frame of the mesh
  double near = 0, reach = 0;  // m, as those of touch()
  bool isFast = false;         // `ways`: triangles within reach are met on the way
  Way way, wayOfMesh;
  double approach = 0;  // m: the most that the two come closer on it
  double close = 0;     // m: a touch on the way
};

// The first manifold goes to `first`, further ones to `more`, all in the frames of solid and mesh.
// The answer is that of touch(); `calls` counts narrow-phase evaluations. `met`: something was
// found on the way.
double touchMesh(const Solid& a, const Solid& mesh, const MeshLook& look, Manifold& first,
                 std::vector<Manifold>& more, int& calls, bool& met);

// Signed distance, by all triangles: for measures and tests.
double meshDistance(const Solid& a, const Solid& mesh, const Relative& pose);

}  // namespace physics::collision
