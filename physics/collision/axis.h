// Separating directions: the flat faces and the edges of two solids (Gottschalk's separating axes).
#pragma once

#include "physics/collision/contacts.h"
#include "physics/collision/solid.h"

namespace physics::collision {

// A direction n from b to a (b's frame), with the distance of the cores along it: negative is
// depth.
struct Axis {
  enum class From { none, facetB, facetA, lines, points };
  From from = From::none;
  Vec3 n = Vec3::UnitY();
  double separation = -1e300;
  int indexA = -1, indexB = -1;  // facets or edges
};

// min over a of n . p  -  max over b of n . p.
double separationAlong(const Solid& a, const Solid& b, const Relative& pose, const Vec3& n);

// Two polyhedra with so many edges that pairs of them are not tried.
bool tooManyEdges(const Solid& a, const Solid& b);

// The best of each sort. For two polyhedra their largest separation is the signed distance whenever
// they overlap. Stops early with only one found when that separation exceeds `enough`.
struct Axes {
  Axis facetB, facetA, lines;
  const Axis& largest() const;
  // A facet unless the edges separate clearly better, b's unless a's does: neighbouring
  // directions do not flicker from step to step.
  const Axis& preferred(double tolerance) const;
};
Axes findAxes(const Solid& a, const Solid& b, const Relative& pose, double enough);
// The same for a box or capsule a and a box b; `lines` only where they are the largest.
Axes findBoxAxes(const Solid& a, const Solid& b, const Relative& pose, double enough);

// The edge of a polyhedron, or the axis of a capsule or cylinder, in the body frame.
Line lineOf(const Solid& solid, int index);

}  // namespace physics::collision
