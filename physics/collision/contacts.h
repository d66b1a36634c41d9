// From a touching direction to a manifold: candidate points and the choice of four.
#pragma once

#include <array>
#include <cstdint>

#include "physics/collision/collider.h"
#include "physics/collision/patch.h"
#include "physics/collision/solid.h"

namespace physics::collision {

// What two solids have in common, in b's frame. Cores as in ContactPoint.
struct Candidate {  // left uninitialised on purpose, as Patch::Corner
  Vec3 onA, onB;
  double gap;
  std::uint32_t feature;
};
struct Contacts {
  Vec3 n = Vec3::UnitY();  // from b to a
  double radiusA = 0, radiusB = 0;
  int count = 0;
  std::array<Candidate, Patch::kRoom> points;

  void add(const Vec3& onA, const Vec3& onB, std::uint32_t feature) {
    points[count++] = {onA, onB, n.dot(onA - onB) - radiusA - radiusB, feature};
  }
  double smallestGap() const;  // +infinity when there is none
};

// Two lines of the cores, each with the radius of its surface.
struct Line {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
};
struct LinePoints {
  Vec3 onA = Vec3::Zero(), onB = Vec3::Zero();
};
LinePoints closestPoints(const Line& a, const Line& b);

enum class Owner { a, b };  // whose face is flat: its normal is the contact's

// How far two points lie beside each other, seen along n.
double offset(const Vec3& n, const Vec3& apart);

// Clips what the other solid turns towards facet `index` of the owner by the side planes of the
// facet.
void touchFacet(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int index,
                Contacts& contacts);

// Two segments that are nearly parallel touch in two points, no more than `flatness` beside each
// other; others in the closest two. n and the radii are set.
void touchLines(const Line& a, const Line& b, std::uint32_t feature, double flatness,
                Contacts& contacts);

// Keeps the points with gap <= keep, at most four of them: the furthest along the diagonals of the
// plane of touch, and the deepest where it is deeper than those by more than `clearly` [m]. Ties
// within `tie` metres go to the earlier point.
void finish(const Contacts& contacts, const Relative& pose, double keep, double tie, double clearly,
            Manifold& out);

// Feature tags in the two top bits but one; the top bit tells the owner of a facet.
constexpr std::uint32_t kFacetTag = 0u << 29, kLinesTag = 1u << 29, kPointTag = 2u << 29;

}  // namespace physics::collision
