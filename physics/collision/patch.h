// Patches: the flat or straight part of a solid that faces a direction, and their clipping.
#pragma once

#include <array>
#include <cstdint>

#include "physics/collision/solid.h"

namespace physics::collision {

// A point, a segment or a convex polygon of the core. The surface lies `radius` further along the
// direction that the patch was made for.
struct Patch {
  static constexpr int kMax = 48;    // corners kept of one face; more are thinned out evenly
  static constexpr int kRoom = 128;  // each cut adds at most one
  struct Corner {  // left uninitialised on purpose: made millions of times a second
    Vec3 p;
    std::uint32_t id;    // of this corner
    std::uint32_t edge;  // of the edge to the next corner
  };
  int count = 0;
  double radius = 0;
  std::array<Corner, kRoom> corners;

  void add(const Vec3& p, std::uint32_t id) { corners[count++] = {p, id, id}; }
};

// Ids of what a cut by a side of a polygon makes: a corner, and the edge along that side.
inline std::uint32_t cutId(std::uint32_t edge, std::uint32_t side) {
  return 1u << 16 | (edge & 0xff) << 8 | (side & 0xff);
}
inline std::uint32_t otherCut(std::uint32_t id) { return id ^ 0x80; }  // of one edge by one side
inline std::uint32_t sideId(std::uint32_t side) { return 0x80 | (side & 0x7f); }

// The patch of `solid` that faces the unit vector d, both in the body frame: a polyhedron's face
// nearest to d, a cylinder's cap (polygon of kRim corners, one of them the furthest along d) or
// side line.
void facing(const Solid& solid, const Vec3& d, Patch& patch);
int nearestFace(const Solid& solid, const Vec3& d);

// Flat faces of a polyhedron, and the caps 0 (-y) and 1 (+y) of a cylinder.
struct Facet {
  Vec3 normal = Vec3::UnitY();
  double offset = 0;
};
int facetCount(const Solid& solid);
Facet facet(const Solid& solid, int index);
void facetPatch(const Solid& solid, int index, Patch& patch);

// Moves the patch from a's frame to b's.
void transform(Patch& patch, const Relative& pose);

// Cuts `patch` by the side planes of the polygon `reference` (counter-clockwise about `normal`),
// each moved outwards by `tolerance`.
void clip(Patch& patch, const Patch& reference, const Vec3& normal, double tolerance);

}  // namespace physics::collision
