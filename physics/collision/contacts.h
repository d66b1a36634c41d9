// From a touching direction to a manifold: candidate points and the choice of four.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "physics/collision/collider.h"
#include "physics/collision/feature.h"
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

// A line of a core: an edge, or the axis of what is round.
struct Line {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  double rounding = 0;  // of the solid
};
struct LinePoints {
  Vec3 onA = Vec3::Zero(), onB = Vec3::Zero();
};
LinePoints closestPoints(const Line& a, const Line& b);

// How far two points lie beside each other, seen along n.
double offset(const Vec3& n, const Vec3& apart);

// Facet `index` of the owner, in b's frame, and what the other solid turns towards `outwards`, cut
// by the side planes of the facet along that: moved outwards by `tolerance` [m].
Facet facetInB(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int index);
void layOnFacet(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int index,
                const Vec3& outwards, double tolerance, Patch& other);

// That as a touch, along the facet's normal.
void touchFacet(const Solid& a, const Solid& b, const Relative& pose, Owner owner, int index,
                Contacts& contacts);

// Where two segments are closest and, of what is round, where they part: lines that turn a little
// meet there next. Of segments no more than `flatness` beside each other where they part, only
// that. n and the radii are set.
void touchLines(const Line& a, const Line& b, std::uint32_t feature, double flatness,
                Contacts& contacts);

// Where the two solids are at the end of the step.
struct Ends {
  Pose a, b;
};

// What gaps along n, the normal of a facet of the owner (b's frame, from b to a), change by in the
// step.
class GapChange {
 public:
  GapChange(const Relative& pose, const Vec3& n, const Ends& ends, Owner owner);
  double of(const Vec3& p) const { return move_ + slope_.dot(p); }  // of the other, b's frame

 private:
  Vec3 slope_;
  double move_;
};

// Which of the points found are kept.
struct Limits {
  double keep = 0;     // m: gaps up to this
  double tie = 0;      // m: points this close in rank are one, the earlier
  double clearly = 0;  // m: a point this much deeper than those chosen is chosen
  std::span<const std::uint32_t> before = {};  // features of the points that were kept last
  const Ends* ends = nullptr;                  // none: nothing is known of them

  // There are more than a manifold has, and the step tells which of them are needed at its end.
  bool looksAhead(int count) const { return ends != nullptr && count > Manifold::kMaxPoints; }
};

// A point in the plane of touch; u and v along two axes of the plane.
struct Spot {  // left uninitialised on purpose
  double u, v, gap;
  double ahead;  // the gap at the end of the step, where Limits::looksAhead
  std::uint32_t feature;
};
struct Choice {
  std::array<int, Manifold::kMaxPoints> index{};
  int count = 0;

  bool has(int i) const {
    bool found = false;
    for (int k = 0; k < count; ++k) found = found || index[k] == i;
    return found;
  }
  void take(int i) {
    if (!has(i)) index[count++] = i;
  }
  template <class F>
  void sort(const F& feature) {
    for (int k = 1; k < count; ++k) {
      for (int l = k; l > 0 && feature(index[l]) < feature(index[l - 1]); --l) {
        std::swap(index[l - 1], index[l]);
      }
    }
  }
};
// At most four of the spots: those that were kept last while they span half of what touches, else
// those that span the most; and the deepest, and the one that will be, where it is clearly deeper
// than those: without it a corner that turns in would be missed for a step. What a body
// leans on beside those that span the most stays when it no longer leans.
Choice choose(std::span<const Spot> spots, const Limits& limits);

// Fills the manifold with the points chosen, by feature.
void finish(const Contacts& contacts, const Relative& pose, const Limits& limits, Manifold& out);

// Of the smaller size:
constexpr double kSideTolerance = 1e-4;  // aligned edges do not flicker
constexpr double kFlat = 5e-4;           // directions this close are one
constexpr double kDeeper = 1e-3;         // a corner this much deeper is kept
constexpr double kTie = 1e-4;            // points this close in rank are one

}  // namespace physics::collision
