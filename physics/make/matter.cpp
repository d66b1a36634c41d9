// Masses, extents and random numbers for the generators.
#include "physics/make/matter.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "physics/bodies/compound.h"

namespace physics {
namespace {

double boxReach(const Vec3& size, const Vec3& d) { return 0.5 * size.dot(d.cwiseAbs()); }

double cylinderReach(double radius, double length, const Vec3& d) {
  return radius * std::hypot(d.x(), d.z()) + 0.5 * length * std::abs(d.y());
}

double compoundReach(const Parts& parts, const Vec3& d) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Part& part : parts.list) {
    most = std::max(most, part.pose.x.dot(d) + reach(part.shape, part.pose.q, d));
  }
  return most;
}

double hullReach(const Hull& hull, const Vec3& d) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : hull.vertices) most = std::max(most, vertex.dot(d));
  return most;
}

}  // namespace

double massOf(const Shape& shape, const Matter& matter) {
  if (matter.mass) return *matter.mass;
  const double volume = massProperties(shape).volume;
  require(volume > 0, "expected a mass: this shape has no volume");
  return volume * matter.density.value_or(kWaterDensity);
}

BodyDef bodyOf(const Shape& shape, const Matter& matter, const Pose& pose) {
  BodyDef def;
  def.shape = shape;
  def.mass = massOf(shape, matter);
  def.friction = matter.friction;
  def.restitution = matter.restitution;
  def.pose = pose;
  return def;
}

double reach(const Shape& shape, const Quat& q, const Vec3& direction) {
  const Vec3 d = q.conjugate() * direction;
  if (const auto* box = std::get_if<Box>(&shape)) return boxReach(box->size, d);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* c = std::get_if<Capsule>(&shape))
    return c->radius + 0.5 * c->length * std::abs(d.y());
  if (const auto* c = std::get_if<Cylinder>(&shape)) return cylinderReach(c->radius, c->length, d);
  if (const auto* convex = std::get_if<Convex>(&shape)) return hullReach(*convex->hull, d);
  if (const auto* several = std::get_if<Compound>(&shape)) return compoundReach(*several->parts, d);
  return 0;
}

std::uint64_t Random::next() {
  state_ += 0x9e3779b97f4a7c15ull;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

double Random::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
}

Vec3 Random::inBall(double radius) {
  for (;;) {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = uniform(-1, 1);
    if (p.squaredNorm() <= 1) return radius * p;
  }
}

Quat Random::rotation(double largestAngle) {
  Vec3 axis = inBall(1);
  while (axis.norm() < 1e-3) axis = inBall(1);
  return exponential(uniform(0, largestAngle) * axis.normalized());
}

}  // namespace physics
