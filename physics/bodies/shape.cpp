// Volumes, moments of inertia and bounds of the shapes.
#include "physics/bodies/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/base/rotation.h"
#include "physics/bodies/compound.h"
#include "physics/bodies/hull.h"
#include "physics/bodies/triangles.h"

namespace physics {
namespace {

MassProperties of(const PointShape&) { return {}; }

MassProperties of(const Plane& plane) {
  require(plane.normal.norm() > 0, "plane: the normal must not be zero");
  return {};
}

MassProperties of(const Box& box) {
  require(box.size.minCoeff() > 0, "box: every size must be positive");
  const Vec3 square = box.size.cwiseAbs2();
  return {box.size.prod(), (Vec3::Constant(square.sum()) - square) / 12};
}

MassProperties of(const Sphere& sphere) {
  require(sphere.radius > 0, "sphere: radius must be positive");
  const double r = sphere.radius;
  return {4 * kPi * r * r * r / 3, Vec3::Constant(0.4 * r * r)};
}

// A cylinder and two half spheres, weighted by their volumes; the centre of mass of a half sphere
// lies 3 r / 8 above its flat side.
MassProperties of(const Capsule& capsule) {
  require(capsule.radius > 0, "capsule: radius must be positive");
  require(capsule.length >= 0, "capsule: length must not be negative");
  const double r = capsule.radius, l = capsule.length;
  const double tube = kPi * r * r * l, caps = 4 * kPi * r * r * r / 3;
  const double share = tube / (tube + caps);
  const double across =
      share * (r * r / 4 + l * l / 12) + (1 - share) * (0.4 * r * r + l * l / 4 + 3 * r * l / 8);
  const double along = share * r * r / 2 + (1 - share) * 0.4 * r * r;
  return {tube + caps, Vec3(across, along, across)};
}

MassProperties of(const Cylinder& cylinder) {
  require(cylinder.radius > 0, "cylinder: radius must be positive");
  require(cylinder.length > 0, "cylinder: length must be positive");
  const double r = cylinder.radius, l = cylinder.length;
  const double across = r * r / 4 + l * l / 12;
  return {kPi * r * r * l, Vec3(across, r * r / 2, across)};
}

// The hull of makeHull has its principal axes along the frame, so the diagonal is all there is.
MassProperties of(const Convex& convex) {
  require(convex.hull != nullptr, "convex: the hull is missing");
  const PolyhedronMass mass = polyhedronMass(*convex.hull);
  return {mass.volume, mass.inertiaPerMass.diagonal()};
}

MassProperties of(const Compound& compound) {
  require(compound.parts != nullptr, "compound: the parts are missing");
  return {compound.parts->volume, compound.parts->inertiaPerMass};
}

MassProperties of(const Triangles& triangles) {
  require(triangles.mesh != nullptr, "triangles: the mesh is missing");
  return {};
}

double radiusOf(const PointShape&) { return 0; }
double radiusOf(const Box& box) { return 0.5 * box.size.norm(); }
double radiusOf(const Sphere& sphere) { return sphere.radius; }
double radiusOf(const Capsule& capsule) { return 0.5 * capsule.length + capsule.radius; }
double radiusOf(const Plane&) { return std::numeric_limits<double>::infinity(); }

double radiusOf(const Cylinder& cylinder) {
  return std::sqrt(cylinder.radius * cylinder.radius + 0.25 * cylinder.length * cylinder.length);
}

double radiusOf(const Convex& convex) {
  require(convex.hull != nullptr, "convex: the hull is missing");
  double square = 0;
  for (const Vec3& vertex : convex.hull->vertices) square = std::max(square, vertex.squaredNorm());
  return std::sqrt(square);
}

double radiusOf(const Compound& compound) {
  require(compound.parts != nullptr, "compound: the parts are missing");
  double radius = 0;
  for (const Part& part : compound.parts->list) {
    radius = std::max(radius, part.pose.x.norm() + boundingRadius(part.shape));
  }
  return radius;
}

double radiusOf(const Triangles& triangles) {
  require(triangles.mesh != nullptr, "triangles: the mesh is missing");
  double square = 0;
  for (const Vec3& vertex : triangles.mesh->vertices) {
    square = std::max(square, vertex.squaredNorm());
  }
  return std::sqrt(square);
}

}  // namespace

MassProperties massProperties(const Shape& shape) {
  return std::visit([](const auto& s) { return of(s); }, shape);
}

double boundingRadius(const Shape& shape) {
  return std::visit([](const auto& s) { return radiusOf(s); }, shape);
}

bool isGroundOnly(const Shape& shape) {
  return std::holds_alternative<Plane>(shape) || std::holds_alternative<Triangles>(shape);
}

}  // namespace physics
