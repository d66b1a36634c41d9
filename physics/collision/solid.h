// A shape as the narrow phase sees it: a convex core (point, segment, cylinder or polyhedron),
// rounded by a radius, with its edges and bounds worked out once; or a mesh of triangles.
#pragma once

#include <memory>
#include <vector>

#include "physics/base/types.h"
#include "physics/bodies/shape.h"

namespace physics::collision {

// In the order of the pairs: a manifold's body a never has a later kind than its body b.
enum class SolidKind { point, sphere, capsule, cylinder, box, convex, plane, triangles };

// An edge of a polyhedron with the outward normals of its two faces.
struct Edge {
  int from = 0, to = 0;
  Vec3 normal0 = Vec3::Zero(), normal1 = Vec3::Zero();
};

class TriangleTree;
struct Solid {
  SolidKind kind = SolidKind::point;
  double size = 0;                    // bounding radius; 0 for point and plane
  Vec3 half = Vec3::Zero();           // of the core of a box or capsule
  double rounding = 0;                // radius around the core: sphere, capsule
  double thickness = 0;               // smallest full extent; 0 for point and plane
  double coreRadius = 0;              // reach of the core from the origin
  double radius = 0, halfLength = 0;  // of a cylinder or capsule, along y
  std::shared_ptr<const Hull> hull;   // of a box or convex
  std::vector<Edge> edges;            // of a box or convex
  Vec3 normal = Vec3::UnitY();        // of a plane: normal . p <= offset is solid
  double offset = 0;
  std::shared_ptr<const TriangleTree> triangles;  // triangle_tree.h
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();   // bounds in the body frame; of a plane: none

  bool isSheet = false;  // a flat polyhedron, without an inside

  bool isPolyhedron() const { return kind == SolidKind::box || kind == SolidKind::convex; }
  bool isLine() const { return kind == SolidKind::capsule || kind == SolidKind::cylinder; }
};

// Of two that may touch: what their tolerances are shares of. A point, a plane and a mesh have
// none.
double smallerSize(const Solid& a, const Solid& b);

// Throws std::invalid_argument for sizes that make no solid.
Solid makeSolid(const Shape& shape);

// Pose of a's frame seen from b's: p_b = R p_a + t.
struct Relative {
  Mat3 R = Mat3::Identity();
  Vec3 t = Vec3::Zero();
};
inline Relative inverse(const Relative& r) { return {r.R.transpose(), -(r.R.transpose() * r.t)}; }
Relative relativePose(const Pose& a, const Pose& b);

// The point of the core that lies furthest along d (body frame, any length but zero).
Vec3 support(const Solid& solid, const Vec3& d);

// The corners of a box's faces, as those of boxHull(): -x, +x, -y, +y, -z, +z, each
// counter-clockwise from outside.
constexpr int kBoxFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

// Bit k of a box's corner, as in boxHull(), tells its side along axis k.
inline Vec3 cornerOf(const Solid& box, int corner) {
  return {corner & 1 ? box.half.x() : -box.half.x(), corner & 2 ? box.half.y() : -box.half.y(),
          corner & 4 ? box.half.z() : -box.half.z()};
}

// How far the solid reaches along the unit vector d (body frame); a plane only along its normal.
inline double reachAlong(const Solid& s, const Vec3& d) {
  if (s.kind <= SolidKind::capsule || s.kind == SolidKind::box)
    return s.half.dot(d.cwiseAbs()) + s.rounding;
  return s.kind == SolidKind::plane ? s.offset : support(s, d).dot(d);
}

// Bounds of the solid at a pose, world frame.
struct Bounds {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};
Bounds boundsAt(const Solid& solid, const Vec3& x, const Mat3& R);

}  // namespace physics::collision
