// Search over the flat faces and edges of two solids.
#include "physics/collision/axis.h"

#include <cmath>

namespace physics::collision {
namespace {

constexpr double kParallel = 1e-8;  // sine squared: a normal known to 1e-12
constexpr double kSquare = 1e-6;    // cosine

// Best facet of `flat`; `pose` takes the other into its frame.
Axis bestFacet(const Solid& flat, const Solid& other, const Relative& pose, double enough) {
  Axis best;
  for (int i = 0; i < facetCount(flat); ++i) {
    const Facet f = facet(flat, i);
    const Vec3 p = support(other, -(pose.R.transpose() * f.normal));
    const double s = f.normal.dot(pose.R * p + pose.t) - f.offset;
    if (s <= best.separation) continue;
    best.separation = s;
    best.n = f.normal;
    best.indexB = i;
    if (s > enough) break;
  }
  return best;
}

void keepLarger(Axis& best, const Vec3& n, double separation, int indexA, int indexB) {
  if (separation > best.separation) {
    best = {Axis::From::lines, n, separation, indexA, indexB};
  }
}

// Gauss map: the arc between the normals of an edge of a and that of an edge of b (reversed) cross
// exactly when the two edges span a face of the Minkowski difference. u, v: the edges' directions,
// oriented as cross(normal1, normal0).
bool spanFace(const Vec3& a0, const Vec3& a1, const Vec3& u, const Vec3& b0, const Vec3& b1,
              const Vec3& v) {
  const double c = -b0.dot(u), d = -b1.dot(u), e = -a0.dot(v), f = -a1.dot(v);
  return c * d < 0 && e * f < 0 && c * f < 0;
}

struct PlacedEdge {
  Vec3 normal0 = Vec3::Zero(), normal1 = Vec3::Zero(), along = Vec3::Zero(), point = Vec3::Zero();
};

PlacedEdge placed(const Solid& s, const Edge& edge, const Relative& pose) {
  const auto& p = s.hull->vertices;
  PlacedEdge e{pose.R * edge.normal0, pose.R * edge.normal1, pose.R * (p[edge.to] - p[edge.from]),
               pose.R * p[edge.from] + pose.t};
  return e;
}

Axis bestEdges(const Solid& a, const Solid& b, const Relative& pose) {
  Axis best;
  if (tooManyEdges(a, b)) return best;
  for (std::size_t i = 0; i < a.edges.size(); ++i) {
    const PlacedEdge ea = placed(a, a.edges[i], pose);
    for (std::size_t j = 0; j < b.edges.size(); ++j) {
      const Edge& eb = b.edges[j];
      const Vec3& from = b.hull->vertices[eb.from];
      const Vec3 along = b.hull->vertices[eb.to] - from;
      if (!spanFace(ea.normal0, ea.normal1, ea.along, eb.normal0, eb.normal1, along)) continue;
      Vec3 n = ea.along.cross(along);
      const double square = n.squaredNorm();
      if (square < kParallel * ea.along.squaredNorm() * along.squaredNorm()) continue;
      n *= (n.dot(eb.normal0 + eb.normal1) < 0 ? -1 : 1) / std::sqrt(square);
      keepLarger(best, n, n.dot(ea.point - from), static_cast<int>(i), static_cast<int>(j));
    }
  }
  return best;
}

// The side of a capsule or cylinder against the edges of a polyhedron: the directions square to its
// axis are a great circle, which an edge's arc of normals either crosses or not.
Axis bestSide(const Solid& a, const Solid& b, const Relative& pose) {
  Axis best;
  const Vec3 u = pose.R.col(1);
  const double radius = a.radius - a.rounding;
  for (std::size_t j = 0; j < b.edges.size(); ++j) {
    const Edge& edge = b.edges[j];
    if (edge.normal0.dot(u) * edge.normal1.dot(u) >= 0) continue;
    const Vec3& from = b.hull->vertices[edge.from];
    const Vec3 along = b.hull->vertices[edge.to] - from;
    Vec3 n = u.cross(along);
    if (n.squaredNorm() < kParallel * along.squaredNorm()) continue;
    n = (n.dot(edge.normal0 + edge.normal1) < 0 ? -n : n).normalized();
    keepLarger(best, n, n.dot(pose.t - from) - radius, 0, static_cast<int>(j));
  }
  return best;
}

// Two of capsule and cylinder: from axis to axis, along their common perpendicular where there is
// one.
Axis bestSides(const Solid& a, const Solid& b, const Relative& pose) {
  Axis best;
  const Vec3 u = pose.R.col(1);
  const Line axisA{pose.t - a.halfLength * u, pose.t + a.halfLength * u}, axisB = lineOf(b, 0);
  const LinePoints closest = closestPoints(axisA, axisB);
  const Vec3 apart = closest.onA - closest.onB;
  const Vec3 cross = u.cross(Vec3::UnitY());
  for (const Vec3& d : {apart, Vec3(cross.dot(pose.t) < 0 ? -cross : cross)}) {
    if (d.squaredNorm() < kParallel * (a.size * a.size + b.size * b.size)) continue;
    const Vec3 n = d.normalized();
    const bool square = std::abs(n.dot(u)) < kSquare || a.kind != SolidKind::cylinder;
    if (!square || std::abs(n.y()) > kSquare) continue;  // b is a cylinder
    keepLarger(best, n, separationAlong(a, b, pose, n), 0, 0);
  }
  return best;
}

}  // namespace

bool tooManyEdges(const Solid& a, const Solid& b) { return a.edges.size() * b.edges.size() > 4000; }

double separationAlong(const Solid& a, const Solid& b, const Relative& pose, const Vec3& n) {
  const Vec3 onA = pose.R * support(a, -(pose.R.transpose() * n)) + pose.t;
  return n.dot(onA - support(b, n));
}

const Axis& Axes::largest() const {
  const Axis& facet = facetA.separation > facetB.separation ? facetA : facetB;
  return lines.separation > facet.separation ? lines : facet;
}

const Axis& Axes::preferred(double tolerance) const {
  const auto clearly = [&](const Axis& better, const Axis& than) {
    return better.separation > than.separation + tolerance;
  };
  const Axis& facet = clearly(facetA, facetB) ? facetA : facetB;
  return clearly(lines, facet) ? lines : facet;
}

Line lineOf(const Solid& s, int index) {
  if (s.kind == SolidKind::box) {  // as in boxHull(), out of the cache's way
    constexpr int kEnds[12][2] = {{0, 1}, {0, 2}, {0, 4}, {1, 3}, {1, 5}, {2, 3},
                                  {2, 6}, {3, 7}, {4, 5}, {4, 6}, {5, 7}, {6, 7}};
    return {cornerOf(s, kEnds[index][0]), cornerOf(s, kEnds[index][1])};
  }
  if (s.isPolyhedron()) {
    const Edge& edge = s.edges[index];
    return {s.hull->vertices[edge.from], s.hull->vertices[edge.to]};
  }
  return {Vec3(0, -s.halfLength, 0), Vec3(0, s.halfLength, 0), s.rounding};
}

Axes findAxes(const Solid& a, const Solid& b, const Relative& pose, double enough) {
  Axes axes;
  axes.facetB = bestFacet(b, a, pose, enough);
  axes.facetB.from = Axis::From::facetB;
  if (axes.facetB.separation > enough) return axes;
  axes.facetA = bestFacet(a, b, inverse(pose), enough);
  axes.facetA.from = Axis::From::facetA;
  axes.facetA.n = -(pose.R * axes.facetA.n);
  std::swap(axes.facetA.indexA, axes.facetA.indexB);
  if (axes.facetA.separation > enough) return axes;
  if (!b.isPolyhedron()) {
    axes.lines = bestSides(a, b, pose);
  } else if (a.isPolyhedron()) {
    axes.lines = bestEdges(a, b, pose);
  } else {
    axes.lines = bestSide(a, b, pose);
  }
  return axes;
}

}  // namespace physics::collision
