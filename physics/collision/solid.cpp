// Shapes made ready for the narrow phase, support points and bounds.
#include "physics/collision/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "physics/bodies/hull.h"
#include "physics/collision/triangle_tree.h"

namespace physics::collision {
namespace {

void fill(Solid& s, const PointShape&) { s.kind = SolidKind::point; }

void fill(Solid& s, const Sphere& sphere) {
  s.kind = SolidKind::sphere;
  s.rounding = s.radius = sphere.radius;
  s.high = Vec3::Constant(sphere.radius);
  s.thickness = 2 * sphere.radius;
}

void fill(Solid& s, const Capsule& capsule) {
  s.kind = SolidKind::capsule;
  s.rounding = s.radius = capsule.radius;
  s.halfLength = s.coreRadius = s.half.y() = 0.5 * capsule.length;
  s.high = Vec3(s.radius, s.radius + s.halfLength, s.radius);
  s.thickness = 2 * capsule.radius;
}

void fill(Solid& s, const Cylinder& cylinder) {
  s.kind = SolidKind::cylinder;
  s.radius = cylinder.radius;
  s.halfLength = 0.5 * cylinder.length;
  s.coreRadius = std::sqrt(s.radius * s.radius + s.halfLength * s.halfLength);
  s.high = Vec3(s.radius, s.halfLength, s.radius);
  s.thickness = 2 * std::min(s.radius, s.halfLength);
}

// Each edge has the face that goes along it and the one that comes back.
void fillEdges(Solid& s) {
  std::map<std::pair<int, int>, const Hull::Face*> faceAlong;
  for (const Hull::Face& face : s.hull->faces) {
    for (std::size_t k = 0; k < face.vertices.size(); ++k) {
      faceAlong[{face.vertices[k], face.vertices[(k + 1) % face.vertices.size()]}] = &face;
    }
  }
  const auto normalAlong = [&](int from, int to) -> Vec3 {
    const auto found = faceAlong.find({from, to});
    return found == faceAlong.end() ? Vec3(Vec3::Zero()) : found->second->normal;
  };
  for (const auto& [from, to] : s.hull->edges) {
    s.edges.push_back({from, to, normalAlong(from, to), normalAlong(to, from)});
  }
}

void fillPolyhedron(Solid& s) {
  s.low = s.high = s.hull->vertices.at(0);
  for (const Vec3& p : s.hull->vertices) {
    s.low = s.low.cwiseMin(p);
    s.high = s.high.cwiseMax(p);
    s.coreRadius = std::max(s.coreRadius, p.norm());
  }
  s.thickness = 2 * s.coreRadius;
  for (const Hull::Face& face : s.hull->faces) {
    double deepest = 0;
    for (const Vec3& p : s.hull->vertices) {
      deepest = std::max(deepest, face.offset - face.normal.dot(p));
    }
    s.thickness = std::min(s.thickness, deepest);
  }
  fillEdges(s);
}

void fill(Solid& s, const Box& box) {
  s.kind = SolidKind::box;
  s.half = 0.5 * box.size;
  s.hull = std::make_shared<const Hull>(boxHull(s.half));
  fillPolyhedron(s);
}

void fill(Solid& s, const Convex& convex) {
  s.kind = SolidKind::convex;
  s.hull = convex.hull;
  fillPolyhedron(s);
}

void fill(Solid& s, const Plane& plane) {
  s.kind = SolidKind::plane;
  s.normal = plane.normal.normalized();
  s.offset = plane.offset / plane.normal.norm();
}

void fill(Solid&, const Compound&) {
  throw std::invalid_argument("a compound is several solids, not one");
}

void fill(Solid& s, const Triangles& triangles) {
  s.kind = SolidKind::triangles;
  s.triangles = std::make_shared<const TriangleTree>(triangles.mesh);
  s.low = s.high = triangles.mesh->vertices.at(triangles.mesh->faces[0].vertices[0]);
  for (const TriangleMesh::Face& face : triangles.mesh->faces) {
    for (const int i : face.vertices) {
      s.low = s.low.cwiseMin(triangles.mesh->vertices[i]);
      s.high = s.high.cwiseMax(triangles.mesh->vertices[i]);
    }
  }
  s.thickness = std::numeric_limits<double>::infinity();  // what is below is solid
  s.coreRadius = boundingRadius(triangles);
}

Vec3 furthestVertex(const Hull& hull, const Vec3& d) {
  double best = d.dot(hull.vertices[0]);
  std::size_t index = 0;
  for (std::size_t i = 1; i < hull.vertices.size(); ++i) {
    const double along = d.dot(hull.vertices[i]);
    if (along > best) {
      best = along;
      index = i;
    }
  }
  return hull.vertices[index];
}

}  // namespace

Solid makeSolid(const Shape& shape) {
  massProperties(shape);  // its checks on sizes
  Solid solid;
  std::visit([&](const auto& s) { fill(solid, s); }, shape);
  if (!solid.isPolyhedron() && solid.kind != SolidKind::triangles) solid.low = -solid.high;
  if (solid.kind != SolidKind::plane) solid.size = boundingRadius(shape);
  return solid;
}

double smallerSize(const Solid& a, const Solid& b) {
  if (b.kind == SolidKind::triangles) return a.size;
  if (a.size == 0 || b.size == 0) return a.size + b.size;
  return std::min(a.size, b.size);
}

Relative relativePose(const Pose& a, const Pose& b) {
  const Mat3 toB = b.q.toRotationMatrix().transpose();
  return {toB * a.q.toRotationMatrix(), toB * (a.x - b.x)};
}

Vec3 support(const Solid& s, const Vec3& d) {
  switch (s.kind) {
    case SolidKind::capsule:
      return {0, std::copysign(s.halfLength, d.y()), 0};
    case SolidKind::cylinder: {
      const double across = std::sqrt(d.x() * d.x() + d.z() * d.z());
      const double scale = across > 0 ? s.radius / across : 0;
      return {scale * d.x(), std::copysign(s.halfLength, d.y()), scale * d.z()};
    }
    case SolidKind::box:
      return {std::copysign(s.half.x(), d.x()), std::copysign(s.half.y(), d.y()),
              std::copysign(s.half.z(), d.z())};
    case SolidKind::convex:
      return furthestVertex(*s.hull, d);
    default:
      return Vec3::Zero();
  }
}

Bounds boundsAt(const Solid& s, const Vec3& x, const Mat3& R) {
  if (s.kind == SolidKind::point || s.kind == SolidKind::sphere) {
    return {x - Vec3::Constant(s.radius), x + Vec3::Constant(s.radius)};
  }
  if (s.kind == SolidKind::capsule) {
    const Vec3 reach = s.halfLength * R.col(1).cwiseAbs() + Vec3::Constant(s.radius);
    return {x - reach, x + reach};
  }
  const Vec3 centre = x + R * (0.5 * (s.low + s.high));
  const Vec3 reach = R.cwiseAbs() * (0.5 * (s.high - s.low));
  return {centre - reach, centre + reach};
}

}  // namespace physics::collision
