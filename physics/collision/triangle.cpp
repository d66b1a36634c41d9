// The direction in which a solid and a triangle touch, and whether it is the triangle's to give.
#include "physics/collision/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/collision/axis.h"
#include "physics/collision/contacts.h"
#include "physics/collision/gjk.h"
#include "physics/collision/narrow.h"

namespace physics::collision {
namespace {

constexpr double kLean = 1e-3;           // rad: directions this close are one
constexpr double kAlongTriangle = 1e-8;  // sine squared: parallel, else known to 1e-12
constexpr double kFar = std::numeric_limits<double>::infinity();

const Vec3& corner(const Triangle& t, int k) { return t.solid.hull->vertices[k % 3]; }
Vec3 edgeOf(const Triangle& t, int k) { return (corner(t, k + 1) - corner(t, k)).normalized(); }

// Across edge k the direction n is the triangle's: over an open edge any, over a shared one only
// what leans no further than the neighbour's own normal. Over a flat or hollow edge none leans out.
bool owns(const Triangle& t, int k, const Vec3& n) {
  const Vec3 along = edgeOf(t, k);
  const int across = t.mesh->faces[t.face].neighbours[k];
  if (across < 0 || n.dot(along.cross(t.normal)) <= kLean) return true;
  return n.dot(along.cross(t.mesh->faces[across].normal)) <= kLean;
}

// The corner or edge of the triangle that lies furthest along n is what pushes along it.
bool owns(const Triangle& t, const Vec3& n) {
  if (n.dot(t.normal) <= 0) return false;
  std::array<double, 3> along;
  for (int k = 0; k < 3; ++k) along[k] = n.dot(corner(t, k));
  const double least = *std::max_element(along.begin(), along.end()) - kLean * t.solid.size;
  const auto isOn = [&](int k) { return along[k % 3] >= least; };
  for (int k = 0; k < 3; ++k) {
    const bool isEdge = isOn(k) && isOn(k + 1);
    const bool isOther = isOn(k + 2);
    if (isEdge && !isOther) return owns(t, k, n);
  }
  for (int k = 0; k < 3; ++k) {
    if ((isOn(k) || isOn(k + 1)) && !owns(t, k, n)) return false;
  }
  return true;
}

struct Side {
  enum class From { face, facetA, edges } from = From::face;
  Vec3 n = Vec3::UnitY();
  double separation = -kFar;  // of the cores
  int index = 0;              // of a's facet
};

void offer(Side& best, Side::From from, const Vec3& n, double separation, int index) {
  if (separation > best.separation) best = {from, n, separation, index};
}

// Directions square to an edge of the triangle and to `along` of a, out of the triangle.
void offerEdges(const Solid& a, const Triangle& t, const Relative& pose, const Vec3& along,
                Side& best) {
  for (int k = 0; k < 3; ++k) {
    const Vec3 edge = edgeOf(t, k), cross = along.cross(edge);
    if (cross.squaredNorm() < kAlongTriangle * along.squaredNorm()) continue;
    const bool isOut = cross.dot(edge.cross(t.normal)) > 0;
    const Vec3 n = (isOut ? cross : Vec3(-cross)).normalized();
    offer(best, Side::From::edges, n, separationAlong(a, t.solid, pose, n), 0);
  }
}

// Of all but the face.
Side bestOther(const Solid& a, const Triangle& t, const Relative& pose, double enough) {
  Side best;
  for (int i = 0; i < facetCount(a) && best.separation <= enough; ++i) {
    const Vec3 n = -(pose.R * facet(a, i).normal);
    offer(best, Side::From::facetA, n, separationAlong(a, t.solid, pose, n), i);
  }
  if (a.kind == SolidKind::box) {
    for (int i = 0; i < 3; ++i) offerEdges(a, t, pose, pose.R.col(i), best);
  } else if (a.isPolyhedron()) {
    for (const Edge& edge : a.edges) {
      const Vec3 along = a.hull->vertices[edge.to] - a.hull->vertices[edge.from];
      offerEdges(a, t, pose, pose.R * along, best);
    }
  } else if (a.isLine()) {
    offerEdges(a, t, pose, pose.R.col(1), best);
  }
  return best;
}

// Where the cores are apart, the nearest points decide, unless a facet of a says the same.
void takeNearest(const Solid& a, const Triangle& t, const Relative& pose, double tolerance,
                 Side& side, Contacts& contacts) {
  const Distance nearest = coreDistance(a, t.solid, pose);
  const bool isFacet =
      side.from == Side::From::facetA && side.separation >= nearest.distance - tolerance;
  if (nearest.overlap || isFacet) return;
  side = {Side::From::edges, (nearest.onA - nearest.onB).normalized(), nearest.distance, 0};
  contacts.n = side.n;
  contacts.radiusA = a.rounding;
  contacts.radiusB = 0;
  contacts.count = 0;
  contacts.add(nearest.onA, nearest.onB, kPointTag);
}

// Of the direction that was found: the points of the face, of a's facet, or the nearest.
void touchSide(const Solid& a, const Triangle& t, const Relative& pose, const Side& side,
               Contacts& contacts) {
  if (side.from == Side::From::face) return touchFacet(a, t.solid, pose, Owner::b, 0, contacts);
  if (side.from == Side::From::facetA) {
    touchFacet(a, t.solid, pose, Owner::a, side.index, contacts);
    if (contacts.count > 0) return;
  }
  if (contacts.count == 0) touchParting(a, t.solid, pose, side.n, side.separation, contacts);
}

// `pose`: of a in the triangle's own frame. The answer as that of touch().
double touchAbout(const Solid& a, const Triangle& t, const Relative& pose, double reach,
                  double keep, Contacts& contacts) {
  const Vec3 toA = pose.R.transpose() * t.normal;
  const double lowest = t.normal.dot(pose.R * support(a, -toA) + pose.t) - a.rounding;
  const double highest = t.normal.dot(pose.R * support(a, toA) + pose.t) + a.rounding;
  contacts.n = t.normal;
  contacts.count = 0;
  if (lowest > reach) return lowest;
  if (highest < 0) return kFar;
  const Side face{Side::From::face, t.normal, lowest + a.rounding, 0};
  Side side = bestOther(a, t, pose, keep + a.rounding);
  if (side.separation - a.rounding > reach)
    return contacts.n = side.n, side.separation - a.rounding;
  const double tolerance = kFlat * smallerSize(a, t.solid);
  // Of what is round no list of directions is all.
  if (a.kind == SolidKind::cylinder || std::max(side.separation, face.separation) > 0) {
    takeNearest(a, t, pose, tolerance, side, contacts);
  }
  const double distance = std::max(side.separation, face.separation) - a.rounding;
  if (distance > reach) return distance;
  const bool isFace = face.separation >= side.separation - tolerance ||
                      side.n.dot(t.normal) > 1 - 0.5 * kLean * kLean;
  if (isFace || !owns(t, side.n)) {
    // What came fast is pushed in for a step: half of it may be, and the triangle still holds it.
    const bool isInFront = isFace || t.normal.dot(pose.t) > -0.5 * a.thickness;
    contacts.count = 0;
    if (isInFront) touchSide(a, t, pose, face, contacts);
    // Over an edge that is all but flat a point may be beside the faces of both.
    const bool isBeside = contacts.count == 0 && isFace && side.separation > 0;
    if (!isBeside || !owns(t, side.n)) return distance;
  }
  touchSide(a, t, pose, side, contacts);
  return distance;
}

}  // namespace

Triangle::Triangle() {
  hull_ = std::make_shared<Hull>();
  hull_->vertices.resize(3);
  hull_->faces.resize(2);
  hull_->faces[0].vertices = {0, 1, 2};
  hull_->faces[1].vertices = {0, 2, 1};
  solid.hull = hull_;
  solid.kind = SolidKind::convex;
  solid.isSheet = true;
}

void Triangle::set(const TriangleMesh& from, int index) {
  mesh = &from;
  face = index;
  const auto& ids = from.faces[index].vertices;
  normal = from.faces[index].normal;
  centre = (from.vertices[ids[0]] + from.vertices[ids[1]] + from.vertices[ids[2]]) / 3;
  solid.coreRadius = 0;
  for (int k = 0; k < 3; ++k) {
    hull_->vertices[k] = from.vertices[ids[k]] - centre;
    solid.coreRadius = std::max(solid.coreRadius, hull_->vertices[k].norm());
  }
  solid.size = solid.coreRadius;
  for (int k = 0; k < 2; ++k) {
    hull_->faces[k].normal = k == 0 ? normal : Vec3(-normal);
    hull_->faces[k].offset = hull_->faces[k].normal.dot(hull_->vertices[0]);
  }
}

double touchTriangle(const Solid& a, const Triangle& triangle, const Relative& pose, double reach,
                     double keep, Manifold& out) {
  Relative about = pose;
  about.t -= triangle.centre;
  Contacts contacts;
  const double distance = touchAbout(a, triangle, about, reach, keep, contacts);
  const double size = smallerSize(a, triangle.solid);
  out.normal = contacts.n;
  out.count = 0;
  if (distance > reach || contacts.count == 0) return distance;
  finish(contacts, about, {keep, kTie * size, kDeeper * size}, out);
  for (int k = 0; k < out.count; ++k) out.points[k].coreB += triangle.centre;
  return distance;
}

std::optional<double> firstTouch(const Solid& a, const Way& wayA, const Triangle& triangle,
                                 const Way& wayOfMesh, double near, int& calls) {
  const Relative start = relativePose(wayA.start, wayOfMesh.start);
  if (triangle.normal.dot(start.t - triangle.centre) <= 0) return std::nullopt;
  Way way = wayOfMesh;
  for (Pose* pose : {&way.start, &way.end}) pose->x += pose->q * triangle.centre;
  return firstTouch(a, wayA, triangle.solid, way, near, calls);
}

}  // namespace physics::collision
