// Triangles near a solid, and their points gathered by direction: a box on flat ground of many
// triangles touches it in four points.
#include "physics/collision/mesh_contacts.h"

#include <algorithm>
#include <limits>

#include "physics/collision/contacts.h"
#include "physics/collision/triangle.h"
#include "physics/collision/triangle_tree.h"

namespace physics::collision {
namespace {

constexpr double kSameSide = 4e-5;  // 1 - cosine of half a degree: directions this close are one
constexpr std::size_t kMostSides = 250;  // then a point goes to the nearest direction

struct Work {  // of a thread
  Triangle triangle;
  std::vector<int> found;
  std::vector<Contacts> sides;
  std::size_t count = 0;  // of the sides
};

Work& work() {
  thread_local Work own;
  return own;
}

Limits limitsOf(const Solid& a, double keep) { return {keep, kTie * a.size, kDeeper * a.size}; }

// Four points of those there are: room for more.
void thin(const Solid& a, const Relative& pose, double keep, Contacts& side) {
  Manifold four;
  finish(side, pose, limitsOf(a, keep), four);
  side.count = 0;
  for (int k = 0; k < four.count; ++k) {
    const ContactPoint& p = four.points[k];
    side.add(pose.R * p.coreA + pose.t, p.coreB, p.feature);
  }
}

Contacts& sideOf(const Manifold& manifold, Work& w) {
  std::size_t nearest = 0;
  double best = -2;
  const double radius = manifold.points[0].radiusA;
  for (std::size_t k = 0; k < w.count; ++k) {
    const double cosine = w.sides[k].radiusA == radius ? w.sides[k].n.dot(manifold.normal) : -2;
    if (cosine > best) best = cosine, nearest = k;
  }
  if (best > 1 - kSameSide || (w.count == kMostSides && best > -2)) return w.sides[nearest];
  if (w.count == w.sides.size()) w.sides.emplace_back();
  Contacts& side = w.sides[w.count++];
  side.n = manifold.normal;
  side.radiusA = radius;
  side.radiusB = 0;
  side.count = 0;
  return side;
}

void take(const Manifold& manifold, const Solid& a, const MeshLook& look, int face, Work& w) {
  if (manifold.count == 0) return;
  Contacts& side = sideOf(manifold, w);
  if (side.count + manifold.count > Patch::kRoom) thin(a, look.pose, look.reach, side);
  for (int k = 0; k < manifold.count; ++k) {
    const ContactPoint& p = manifold.points[k];
    const auto feature = featureOfPart(p.feature, face);
    side.add(look.pose.R * p.coreA + look.pose.t, p.coreB, feature);
  }
}

// Not near, but met on the way. True: it was.
bool lookAlong(const Solid& a, const MeshLook& look, const Triangle& triangle, Manifold& out,
               int& calls) {
  const auto part = firstTouch(a, look.way, triangle, look.wayOfMesh, look.close, calls);
  if (!part) return false;
  const Relative there = relativePose(along(look.way, *part), along(look.wayOfMesh, *part));
  const double near = std::max(look.close, look.near);
  touchTriangle(a, triangle, there, near, near + (1 - *part) * look.approach, out);
  return out.count > 0;
}

Bounds around(const Solid& a, const MeshLook& look) {
  Bounds bounds = boundsAt(a, look.pose.t, look.pose.R);
  bounds.low.array() -= look.reach;
  bounds.high.array() += look.reach;
  return bounds;
}

void finishAll(const Solid& a, const MeshLook& look, Work& w, Manifold& first,
               std::vector<Manifold>& more) {
  // All that was found is kept: what was met on the way is further off now.
  const Limits limits = limitsOf(a, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < w.count; ++k) {
    Manifold& out = k == 0 ? first : more.emplace_back(first);
    finish(w.sides[k], look.pose, limits, out);
    out.pair = first.pair + k;
  }
}

}  // namespace

double touchMesh(const Solid& a, const Solid& mesh, const MeshLook& look, Manifold& first,
                 std::vector<Manifold>& more, int& calls, bool& met) {
  Work& w = work();
  const TriangleTree& tree = *mesh.triangles;
  tree.find(around(a, look), w.found);
  w.count = 0;
  more.clear();
  first.count = 0;
  met = false;
  // Of all that is not within the bounds, which are exact but for rounding.
  double distance = look.reach * (1 + 1e-9);
  for (const int face : w.found) {
    w.triangle.set(tree.mesh(), face);
    Manifold manifold;
    const double apart = touchTriangle(a, w.triangle, look.pose, look.near, look.reach, manifold);
    ++calls;
    distance = std::min(distance, apart);
    const bool ahead = look.isFast && apart > look.near && apart <= look.reach;
    if (ahead && lookAlong(a, look, w.triangle, manifold, calls)) met = true;
    take(manifold, a, look, face, w);
  }
  finishAll(a, look, w, first, more);
  return distance;
}

double meshDistance(const Solid& a, const Solid& mesh, const Relative& pose) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const TriangleMesh& triangles = mesh.triangles->mesh();
  double smallest = kInfinite;
  Triangle triangle;
  for (int face = 0; face < static_cast<int>(triangles.faces.size()); ++face) {
    triangle.set(triangles, face);
    Manifold ignored;
    smallest = std::min(smallest, touchTriangle(a, triangle, pose, kInfinite, kInfinite, ignored));
  }
  return smallest;
}

}  // namespace physics::collision
