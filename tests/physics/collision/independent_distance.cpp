// Distances a second time.
#include "tests/physics/collision/independent_distance.h"

#include <Eigen/LU>
#include <cmath>

namespace physics::testing {
namespace {

using Real = long double;
using V = Eigen::Matrix<Real, 3, 1>;
using M = Eigen::Matrix<Real, 3, 3>;

constexpr int kSides = 48;  // of the prisms in a cylinder's place
enum class Prism { kInscribed, kCircumscribed };

// A convex core, in the world frame: corners, normals of its faces, directions of its edges; and
// the radius around it. `rim`: the corners stand for two circles.
struct Core {
  std::vector<V> corners, normals, edges;
  Real radius = 0;
  bool isCurved = false;
  V centre = V::Zero(), axis = V::UnitY();
  Real rim = 0, half = 0;
};

void add(Core& core, const PointShape&, Prism) { core.corners = {V::Zero()}; }
void add(Core& core, const Sphere& s, Prism) {
  core.corners = {V::Zero()};
  core.radius = s.radius;
}
void add(Core& core, const Capsule& c, Prism) {
  core.corners = {V(0, -c.length / 2, 0), V(0, c.length / 2, 0)};
  core.edges = {V::UnitY()};
  core.radius = c.radius;
}
void add(Core& core, const Box& box, Prism) {
  for (int i = 0; i < 8; ++i) {
    core.corners.push_back(0.5L * V(i & 1 ? box.size.x() : -box.size.x(),
                                    i & 2 ? box.size.y() : -box.size.y(),
                                    i & 4 ? box.size.z() : -box.size.z()));
  }
  core.edges = core.normals = {V::UnitX(), V::UnitY(), V::UnitZ()};
}
void add(Core& core, const Cylinder& c, Prism prism) {
  core.isCurved = true;
  core.rim = c.radius;
  core.half = c.length / 2.0L;
  const Real step = 2 * 3.141592653589793238463L / kSides;
  const Real r = prism == Prism::kInscribed ? c.radius : c.radius / std::cos(step / 2);
  for (int i = 0; i < kSides; ++i) {
    const V out(std::cos(i * step), 0, std::sin(i * step));
    for (const Real y : {-core.half, core.half}) core.corners.push_back(r * out + y * V::UnitY());
    const V side(std::cos((i + 0.5L) * step), 0, std::sin((i + 0.5L) * step));
    core.normals.push_back(side);
    core.edges.push_back(side.cross(V::UnitY()));
  }
  core.normals.push_back(V::UnitY());
  core.edges.push_back(V::UnitY());
}
void add(Core& core, const Convex& c, Prism) {
  for (const Vec3& p : c.hull->vertices) core.corners.push_back(p.cast<Real>());
  for (const Hull::Face& face : c.hull->faces) core.normals.push_back(face.normal.cast<Real>());
  for (const auto& [i, j] : c.hull->edges) core.edges.push_back(core.corners[i] - core.corners[j]);
}
void add(Core&, const Plane&, Prism) { throw std::logic_error("a plane is no core"); }
void add(Core&, const Compound&, Prism) { throw std::logic_error("a compound is no core"); }
void add(Core&, const Triangles&, Prism) { throw std::logic_error("triangles are no core"); }

Core coreOf(const Shape& shape, const Pose& pose, Prism prism) {
  Core core;
  std::visit([&](const auto& s) { add(core, s, prism); }, shape);
  Eigen::Quaternion<Real> q = pose.q.cast<Real>();
  q.normalize();
  const M turn = q.toRotationMatrix();
  const V x = pose.x.cast<Real>();
  for (V& p : core.corners) p = (turn * p + x).eval();
  for (V& d : core.normals) d = (turn * d).eval().normalized();
  for (V& d : core.edges) d = (turn * d).eval().normalized();
  core.centre = x;
  core.axis = turn * V::UnitY();
  return core;
}

// The furthest point along d; of a cylinder, not of its prism.
V support(const Core& core, const V& d) {
  if (core.isCurved) {
    const Real up = d.dot(core.axis);
    const V across = d - up * core.axis;
    const Real size = across.norm();
    V point = core.centre + (up < 0 ? -core.half : core.half) * core.axis;
    if (size > 1e-12L * d.norm()) point += core.rim / size * across;  // else rounding only
    return point;
  }
  const V* best = core.corners.data();
  for (const V& p : core.corners) {
    if (p.dot(d) > best->dot(d)) best = &p;
  }
  return *best;
}

// Weights of the point nearest to the origin in the affine hull of the points.
Eigen::Matrix<Real, Eigen::Dynamic, 1> affineWeights(const std::vector<V>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> a(n + 1, n + 1);
  Eigen::Matrix<Real, Eigen::Dynamic, 1> right(n + 1);
  a.setZero();
  right.setZero();
  right[n] = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) a(i, j) = points[i].dot(points[j]);
    a(i, n) = a(n, i) = 1;
  }
  return a.fullPivLu().solve(right).head(n);
}

// Wolfe's minor cycle: to the nearest point of the hull of the points, dropping those that are not
// needed. False: the last point, which was new, is of no use, so that this is as near as can be
// told.
bool descend(std::vector<V>& set, std::vector<Real>& weight) {
  const V added = set.back();
  while (true) {
    const auto want = affineWeights(set);
    if (!want.allFinite()) return false;
    Real part = 1;
    for (std::size_t i = 0; i < set.size(); ++i) {
      if (want[i] < 0) part = std::min(part, weight[i] / (weight[i] - want[i]));
    }
    Real sum = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
      weight[i] = std::max(weight[i] + part * (want[i] - weight[i]), Real(0));
      sum += weight[i];
    }
    for (Real& w : weight) w /= sum;
    if (part >= 1) return true;
    for (std::size_t i = set.size(); i-- > 0;) {
      if (weight[i] > 1e-18L || set.size() == 1) continue;
      set.erase(set.begin() + static_cast<std::ptrdiff_t>(i));
      weight.erase(weight.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (set.back() != added) return false;
  }
}

// Wolfe, Finding the nearest point in a polytope (1976), with a support function for the points.
struct Nearest {
  V x = V::Zero();  // of A - B, nearest to the origin
  Real below = 0;   // no point of A - B is nearer than this
};

Nearest nearest(const Core& a, const Core& b, Real size) {
  std::vector<V> set{support(a, V::UnitX()) - support(b, V::UnitX())};
  std::vector<Real> weight{1};
  Nearest result;
  for (int iteration = 0; iteration < 400; ++iteration) {
    V x = V::Zero();
    for (std::size_t i = 0; i < set.size(); ++i) x += weight[i] * set[i];
    const Real length = x.norm();
    result.x = x;
    if (length <= 1e-15L * size) return {x, 0};
    const V p = support(a, -x) - support(b, x);
    result.below = std::max(result.below, x.dot(p) / length);
    if (length - result.below <= 1e-17L * size) return result;
    for (const V& q : set) {
      if ((q - p).norm() <= 1e-18L * size) return result;
    }
    set.push_back(p);
    weight.push_back(0);
    if (!descend(set, weight)) return result;
  }
  return result;
}

struct Best {
  Real separation = -1e300L;
  V n = V::UnitY();
};

void offer(const Core& a, const Core& b, V n, Best& best) {
  const Real size = n.norm();
  if (size < 1e-9L) return;
  n /= size;
  for (const Real sign : {Real(1), Real(-1)}) {
    Real lowA = 1e300L, highB = -1e300L;
    for (const V& p : a.corners) lowA = std::min(lowA, sign * n.dot(p));
    for (const V& p : b.corners) highB = std::max(highB, sign * n.dot(p));
    if (lowA - highB > best.separation) best = {lowA - highB, sign * n};
  }
}

// The largest separation of two polytopes over all directions.
Best deepest(const Core& a, const Core& b) {
  Best best;
  if (a.edges.size() < 2 && b.edges.size() < 2) return {0, best.n};  // their difference is flat
  for (const V& n : a.normals) offer(a, b, n, best);
  for (const V& n : b.normals) offer(a, b, n, best);
  for (const V& e : a.edges) {
    for (const V& f : b.edges) offer(a, b, e.cross(f), best);
  }
  return best;
}

Bounds ofPlane(const Core& a, const Plane& plane, const Pose& pose) {
  Eigen::Quaternion<Real> q = pose.q.cast<Real>();
  q.normalize();
  const Real size = plane.normal.cast<Real>().norm();
  const V n = q.toRotationMatrix() * (plane.normal.cast<Real>() / size);
  const Real d = n.dot(support(a, -n) - pose.x.cast<Real>()) - plane.offset / size - a.radius;
  return {static_cast<double>(d), static_cast<double>(d), n.cast<double>()};
}

Real extent(const Core& core) {
  Real most = 0;
  for (const V& p : core.corners) most = std::max(most, (p - core.centre).norm());
  return most;
}

}  // namespace

Bounds independentDistance(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB) {
  const Core outerA = coreOf(a, poseA, Prism::kCircumscribed);
  if (const auto* plane = std::get_if<Plane>(&b)) return ofPlane(outerA, *plane, poseB);
  const Core outerB = coreOf(b, poseB, Prism::kCircumscribed);
  const Real radii = outerA.radius + outerB.radius;
  const Real size = extent(outerA) + extent(outerB) + (outerA.centre - outerB.centre).norm();
  const Nearest near = nearest(outerA, outerB, size);
  const Real distance = near.x.norm();
  if (near.below > 1e-12L * size) {
    return {static_cast<double>(near.below - radii), static_cast<double>(distance - radii),
            (near.x / distance).cast<double>()};
  }
  const Best low = deepest(outerA, outerB);
  Best high = low;
  if (outerA.isCurved || outerB.isCurved) {
    high = deepest(coreOf(a, poseA, Prism::kInscribed), coreOf(b, poseB, Prism::kInscribed));
  }
  const Real above = high.separation > 0 ? distance : high.separation;
  return {static_cast<double>(std::min(low.separation, Real(0)) - radii),
          static_cast<double>(above - radii), low.n.cast<double>()};
}

Bounds independentDistance(const Vec3& point, const Shape& shape, const Pose& pose) {
  return independentDistance(PointShape{}, Pose{point, Quat::Identity()}, shape, pose);
}

}  // namespace physics::testing
