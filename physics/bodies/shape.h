// Shapes of bodies, in the body frame: origin at the centre of mass, axes along the principal axes.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "physics/base/types.h"

namespace physics {

struct PointShape {};  // no extent, no rotation
struct Box {
  Vec3 size = Vec3::Ones();  // full extents [m]
};
struct Sphere {
  double radius = 0.5;  // m
};
struct Capsule {         // along y
  double radius = 0.25;  // m
  double length = 0.5;   // between the cap centres [m]
};
struct Cylinder {        // along y
  double radius = 0.25;  // m
  double length = 0.5;   // m
};

// Convex polyhedron with planar faces, in the body frame.
struct Hull {
  struct Face {
    std::vector<int> vertices;  // counter-clockwise seen from outside
    Vec3 normal = Vec3::UnitY();
    double offset = 0;  // normal . p = offset on the face
  };
  std::vector<Vec3> vertices;
  std::vector<Face> faces;
  std::vector<std::array<int, 2>> edges;
};
struct Convex {
  std::shared_ptr<const Hull> hull;
};

// The half space normal . p <= offset is solid. Only for bodies that do not move by themselves.
struct Plane {
  Vec3 normal = Vec3::UnitY();
  double offset = 0;  // m
};

// Several shapes that move as one, in the body frame. compound.h
struct Parts;
struct Compound {
  std::shared_ptr<const Parts> parts;
};

// Ground of triangles, solid below: only for bodies that do not move by themselves. triangles.h
struct TriangleMesh;
struct Triangles {
  std::shared_ptr<const TriangleMesh> mesh;
};

using Shape =
    std::variant<PointShape, Box, Sphere, Capsule, Cylinder, Convex, Plane, Compound, Triangles>;

// Volume [m^3] and principal moments of inertia per unit mass [m^2] about the centre of mass.
// PointShape has neither; a Plane and Triangles have no mass: they give zeros.
struct MassProperties {
  double volume = 0;
  Vec3 inertiaPerMass = Vec3::Zero();
};
MassProperties massProperties(const Shape& shape);

// A hull around `points` (>= 4, not in one plane; throws std::invalid_argument otherwise), moved so
// that its centre of mass is the origin and its principal axes are the frame's. `toPoints` takes
// the hull back to where the points were. Axes stay as they are when they are principal already.
struct PrincipalHull {
  std::shared_ptr<const Hull> hull;
  Pose toPoints;
};
PrincipalHull makeHull(std::span<const Vec3> points);

// Radius about the body's origin that holds the shape [m]; infinite for a Plane.
double boundingRadius(const Shape& shape);

// What has no mass and no inside to be pushed out of by itself: a Plane and Triangles.
bool isGroundOnly(const Shape& shape);

}  // namespace physics
