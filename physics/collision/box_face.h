// A box, or the segment of a capsule, over a face of a box: the same points that touchFacet() finds
// for any polyhedron, found in the coordinates of the face.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "physics/collision/contacts.h"

namespace physics::collision {

struct FacePoints {
  static constexpr int kRoom = 8;  // four corners, and one more for each side that cuts
  struct Corner {                  // left uninitialised on purpose, as Patch::Corner
    Spot spot;
    std::uint32_t id, edge;
  };
  Owner owner = Owner::b;
  int face = 0;  // as in boxHull()
  int count = 0;
  std::array<Corner, kRoom> corners;

  double smallestGap() const;  // +infinity when there is none
};

// a: box or capsule, b: box, the owner of the face: a box.
void layOnFace(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int face,
               FacePoints& points);

void finish(const Solid& a, const Solid& b, const Relative& pose, const FacePoints& points,
            const Limits& limits, Manifold& out);

}  // namespace physics::collision
