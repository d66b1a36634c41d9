// Convex hulls by Qhull, brought into the frame of their centre of mass and principal axes.
#include "physics/bodies/hull.h"

#include <libqhull_r/qhull_ra.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "physics/base/rotation.h"

namespace physics {
namespace {

double largestCoordinate(std::span<const Vec3> points) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  return largest;
}

// The corners of one facet in order around its normal, starting from the lowest index.
std::vector<int> around(const Vec3& normal, std::vector<int> ids, std::span<const Vec3> points) {
  std::sort(ids.begin(), ids.end());
  Vec3 centre = Vec3::Zero();
  for (const int i : ids) centre += points[i] / static_cast<double>(ids.size());
  const Vec3 u = points[ids[0]] - centre, v = normal.cross(u);
  std::vector<std::pair<double, int>> order;
  for (const int i : ids) {
    const Vec3 d = points[i] - centre;
    const double angle = i == ids[0] ? 0 : arcTangent(d.dot(v), d.dot(u));
    order.emplace_back(angle < 0 ? angle + 7 : angle, i);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = order[k].second;
  return ids;
}

// Qhull's C interface (its C++ one does not compile as C++20), freed whatever happens.
struct Qhull {
  Qhull() : silent(std::fopen("/dev/null", "w")) { qh_zero(&state, silent); }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    qh_freeqhull(&state, !qh_ALL);
    int left = 0, total = 0;
    qh_memfreeshort(&state, &left, &total);
    if (silent != nullptr) std::fclose(silent);
  }
  std::FILE* silent;
  qhT state{};
};

// Corners of one facet, by index, counter-clockwise from outside.
using Corners = std::vector<int>;

// What fewer than three facets meet in lies on an edge, or on a facet.
void keepCorners(std::vector<Corners>& facets, std::size_t points) {
  std::vector<int> meet(points, 0);
  for (const Corners& corners : facets) {
    for (const int i : corners) ++meet[i];
  }
  for (Corners& corners : facets) std::erase_if(corners, [&](int i) { return meet[i] < 3; });
}

// Of points whose largest coordinate is 1. Facets are one where they are within 1e-5 of one plane:
// files have six digits.
std::vector<Corners> facets(std::span<const Vec3> points) {
  std::vector<double> flat;
  for (const Vec3& p : points) flat.insert(flat.end(), {p.x(), p.y(), p.z()});
  const auto qhull = std::make_unique<Qhull>();
  qhT* const qh = &qhull->state;
  char command[] = "qhull C-1e-5";
  const int failed = qh_new_qhull(qh, 3, static_cast<int>(points.size()), flat.data(), False,
                                  command, nullptr, qhull->silent);
  require(failed == 0, "convex hull: the points lie in one plane, on one line or in one point");
  std::vector<Corners> found;
  for (const facetT* facet = qh->facet_list; facet->next != nullptr; facet = facet->next) {
    Corners ids;
    for (int k = 0; k < qh_setsize(qh, facet->vertices); ++k) {
      const auto* vertex = static_cast<const vertexT*>(facet->vertices->e[k].p);
      ids.push_back(qh_pointid(qh, vertex->point));
    }
    const Vec3 normal(facet->normal[0], facet->normal[1], facet->normal[2]);
    found.push_back(around(normal, std::move(ids), points));
  }
  keepCorners(found, points.size());
  std::sort(found.begin(), found.end());
  return found;
}

// Normal by Newell's sum; the offset is that of the outermost corner, so that all corners are
// inside.
Hull::Face faceOf(std::vector<int> ids, std::span<const Vec3> vertices) {
  Hull::Face face;
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = vertices[ids[0]];
  for (std::size_t k = 1; k + 1 < ids.size(); ++k) {
    sum += (vertices[ids[k]] - origin).cross(vertices[ids[k + 1]] - origin);
  }
  require(sum.norm() > 0, "convex hull: a face has no area");
  face.normal = sum.normalized();
  face.offset = face.normal.dot(origin);
  for (const int i : ids) face.offset = std::max(face.offset, face.normal.dot(vertices[i]));
  face.vertices = std::move(ids);
  return face;
}

void collectEdges(Hull& hull) {
  for (const Hull::Face& face : hull.faces) {
    for (std::size_t k = 0; k < face.vertices.size(); ++k) {
      const int from = face.vertices[k], to = face.vertices[(k + 1) % face.vertices.size()];
      if (from < to) hull.edges.push_back({from, to});
    }
  }
  std::sort(hull.edges.begin(), hull.edges.end());
}

Hull moved(const Hull& hull, const Vec3& centre, const Mat3& toAxes) {
  Hull result;
  for (const Vec3& p : hull.vertices) result.vertices.push_back(toAxes * (p - centre));
  for (const auto& face : hull.faces)
    result.faces.push_back(faceOf(face.vertices, result.vertices));
  result.edges = hull.edges;
  return result;
}

}  // namespace

Mat3 principalAxes(const Mat3& inertia) {
  const Mat3 off = inertia - Mat3(inertia.diagonal().asDiagonal());
  if (off.norm() <= 1e-9 * inertia.norm()) return Mat3::Identity();
  Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvectors();
  for (int i = 0; i < 2; ++i) {  // the sign that leaves the axis closer to a frame axis
    int largest = 0;
    axes.col(i).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, i) < 0) axes.col(i) = -axes.col(i);
  }
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

PolyhedronMass polyhedronMass(const Hull& hull) {
  const Vec3 origin = hull.vertices.at(0);
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // integral of p pᵀ
  for (const Hull::Face& face : hull.faces) {
    const Vec3 a = hull.vertices[face.vertices[0]] - origin;
    for (std::size_t k = 1; k + 1 < face.vertices.size(); ++k) {
      const Vec3 b = hull.vertices[face.vertices[k]] - origin;
      const Vec3 c = hull.vertices[face.vertices[k + 1]] - origin;
      const double v = a.dot(b.cross(c)) / 6;
      const Vec3 s = a + b + c;
      volume += v;
      first += v / 4 * s;
      second +=
          v / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
    }
  }
  require(volume > 0,
          "polyhedron: the volume must be positive, faces counter-clockwise from outside");
  const Vec3 centre = first / volume;
  const Mat3 spread = second / volume - centre * centre.transpose();
  return {volume, origin + centre, spread.trace() * Mat3::Identity() - spread};
}

Hull convexHull(std::span<const Vec3> points) {
  require(points.size() >= 4,
          "convex hull: at least 4 points are needed, not " + std::to_string(points.size()));
  for (const Vec3& p : points) require(p.allFinite(), "convex hull: a point is not finite");
  const double scale = largestCoordinate(points);
  require(scale > 0, "convex hull: all points are the origin");
  std::vector<Vec3> unit;  // Qhull's tolerances are absolute in places
  for (const Vec3& p : points) unit.push_back(p / scale);
  std::vector<Corners> found = facets(unit);
  std::vector<int> newIndex(points.size(), -1);
  for (const auto& ids : found) {
    for (const int i : ids) newIndex[i] = 0;
  }
  Hull hull;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (newIndex[i] < 0) continue;
    newIndex[i] = static_cast<int>(hull.vertices.size());
    hull.vertices.push_back(points[i]);
  }
  for (auto& ids : found) {
    for (int& i : ids) i = newIndex[i];
    hull.faces.push_back(faceOf(std::move(ids), hull.vertices));
  }
  collectEdges(hull);
  require(hull.vertices.size() + hull.faces.size() == hull.edges.size() + 2,
          "convex hull: the faces do not close; merge points that nearly coincide");
  return hull;
}

PrincipalHull makeHull(std::span<const Vec3> points) {
  const Hull there = convexHull(points);
  const PolyhedronMass mass = polyhedronMass(there);
  const Mat3 axes = principalAxes(mass.inertiaPerMass);
  PrincipalHull result;
  result.hull = std::make_shared<const Hull>(moved(there, mass.centre, axes.transpose()));
  result.toPoints = {mass.centre, Quat(axes).normalized()};
  return result;
}

Hull boxHull(const Vec3& half) {
  Hull hull;
  for (int i = 0; i < 8; ++i) {
    hull.vertices.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                               i & 4 ? half.z() : -half.z());
  }
  const std::vector<std::vector<int>> corners = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& ids : corners) hull.faces.push_back(faceOf(ids, hull.vertices));
  collectEdges(hull);
  return hull;
}

}  // namespace physics
