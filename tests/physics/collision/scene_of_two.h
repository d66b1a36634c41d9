// Two shapes before a collider, and support functions written a second time to judge it by.
#pragma once

#include <random>
#include <span>
#include <string>
#include <vector>

#include "physics/collision/collider.h"

namespace physics::testing {

struct Named {
  std::string name;
  Shape shape;
};
std::vector<Named>
shapes();  // one or more of each kind, all about half a metre wide, the plane last

Convex hullOf(std::span<const Vec3> points);
Convex wedge();
Convex ball(int points);  // a polyhedron with that many corners on a sphere of radius 0.4

// Manifolds of a (id 1) and b (id 2, static) at rest at these poses.
std::vector<Manifold> meet(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB,
                           double margin = 0.02);
double distanceOf(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB);

// Gap and place of a contact point, by the formula in collider.h. Poses indexed by BodyId.
struct Point {
  Vec3 n = Vec3::Zero(), onA = Vec3::Zero(), onB = Vec3::Zero();
  double gap = 0;
};
Point place(const Manifold& manifold, int index, std::span<const Pose> poses);
double smallestGap(const Manifold& manifold, std::span<const Pose> poses);

// The furthest point of the shape along d, world frame. Not for planes.
Vec3 supportOf(const Shape& shape, const Pose& pose, const Vec3& d);
// Distance of the shapes measured along n (from b to a): exact for any direction.
double separation(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB,
                  const Vec3& n);

// Nothing of it may stand twice among a function's arguments: compilers differ in their order.
struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  std::mt19937 engine;
  double number(double low, double high);  // the same on every machine
  Vec3 vector(double low, double high);    // each component so
  Vec3 direction();
  Vec3 within(double furthest);
  Quat rotation();
  Quat lean(double low, double high);  // about any axis [degrees]
  Pose pose(double furthest) { return {within(furthest), rotation()}; }
};

long allocationCount();  // of the whole program so far

Quat turned(const Vec3& axis, double degrees);

}  // namespace physics::testing
