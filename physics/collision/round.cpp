// Spheres, capsules and points in closed form; anything on a plane.
#include "physics/collision/round.h"

#include <algorithm>
#include <cmath>

#include "physics/collision/axis.h"

namespace physics::collision {
namespace {

constexpr double kCoincident = 1e-12;  // of the sizes: no direction can be told

// Nearest point of the surface of b to p, b's frame, and the outward direction there.
struct Nearest {
  Vec3 core = Vec3::Zero();  // the surface is at core + radius n
  Vec3 n = Vec3::UnitY();
  double radius = 0;
  double distance = 0;  // signed
};

Nearest outside(const Vec3& p, const Vec3& nearest) {
  const Vec3 d = p - nearest;
  return {nearest, d.normalized(), 0, d.norm()};
}

Nearest nearestOnBox(const Solid& box, const Vec3& p) {
  const Vec3 inside = p.cwiseMax(-box.half).cwiseMin(box.half);
  if ((p - inside).norm() > kCoincident * box.size) return outside(p, inside);
  int axis = 0;
  Nearest result;
  result.distance = (p.cwiseAbs() - box.half).maxCoeff(&axis);
  result.n = p[axis] < 0 ? Vec3(-Vec3::Unit(axis)) : Vec3(Vec3::Unit(axis));
  result.core = p - result.distance * result.n;
  return result;
}

Nearest nearestOnCylinder(const Solid& c, const Vec3& p) {
  const double across = std::sqrt(p.x() * p.x() + p.z() * p.z());
  const Vec3 radial =
      across > kCoincident * c.size ? Vec3(p.x() / across, 0, p.z() / across) : Vec3(Vec3::UnitX());
  const double beside = across - c.radius, above = std::abs(p.y()) - c.halfLength;
  const Vec3 up(0, p.y() < 0 ? -1 : 1, 0);
  if (beside > 0 && above > 0) return outside(p, c.radius * radial + c.halfLength * up);
  if (beside > above) return {Vec3(0, p.y(), 0), radial, c.radius, beside};
  return {p - above * up, up, 0, above};
}

Vec3 nearestOnFace(const Hull& hull, const Hull::Face& face, const Vec3& p) {
  Vec3 best = p - (face.normal.dot(p) - face.offset) * face.normal;
  double square = -1;
  const Vec3 projected = best;
  for (std::size_t k = 0; k < face.vertices.size(); ++k) {
    const Vec3& from = hull.vertices[face.vertices[k]];
    const Vec3& to = hull.vertices[face.vertices[(k + 1) % face.vertices.size()]];
    const Vec3 edge = to - from;
    if (edge.cross(face.normal).dot(projected - from) <= 0) continue;
    const Vec3 q = from + std::clamp(edge.dot(p - from) / edge.squaredNorm(), 0.0, 1.0) * edge;
    if (square < 0 || (q - p).squaredNorm() < square) {
      best = q;
      square = (q - p).squaredNorm();
    }
  }
  return best;
}

Nearest nearestOnHull(const Solid& s, const Vec3& p) {
  const Hull& hull = *s.hull;
  Nearest best;
  best.distance = -1e300;
  for (const Hull::Face& face : hull.faces) {
    const double height = face.normal.dot(p) - face.offset;
    if (height > best.distance) best = {p - height * face.normal, face.normal, 0, height};
  }
  if (best.distance <= kCoincident * s.size) return best;
  double square = -1;
  Vec3 nearest = Vec3::Zero();
  for (const Hull::Face& face : hull.faces) {
    if (face.normal.dot(p) <= face.offset) continue;
    const Vec3 q = nearestOnFace(hull, face, p);
    if (square >= 0 && (q - p).squaredNorm() >= square) continue;
    nearest = q;
    square = (q - p).squaredNorm();
  }
  return outside(p, nearest);
}

// A unit vector for lines that cross or coincide, on a's side.
Vec3 anyDirection(const Line& a, const Line& b, const Vec3& t) {
  const Vec3 u = a.to - a.from, v = b.to - b.from;
  Vec3 n = u.cross(v);
  if (n.norm() <= 1e-9 * u.norm() * v.norm() || n.norm() == 0) {
    const Vec3& along = u.squaredNorm() > v.squaredNorm() ? u : v;
    n = along.squaredNorm() > 0 ? along.normalized().unitOrthogonal() : Vec3(Vec3::UnitY());
  }
  n.normalize();
  return n.dot(t) < 0 ? Vec3(-n) : n;
}

// A polyhedron's corners near the plane that its facing patch does not have.
void addLowCorners(const Solid& a, const Relative& pose, const Solid& plane, Contacts& contacts) {
  const double low =
      contacts.n.dot(pose.R * support(a, -(pose.R.transpose() * contacts.n)) + pose.t) -
      plane.offset + 0.25 * a.thickness;
  const int patchCount = contacts.count;
  for (std::size_t i = 0; i < a.hull->vertices.size(); ++i) {
    const Vec3 p = pose.R * a.hull->vertices[i] + pose.t;
    const double gap = contacts.n.dot(p) - plane.offset;
    bool known = gap > low || contacts.count == Patch::kRoom;
    for (int k = 0; k < patchCount && !known; ++k) known = contacts.points[k].feature == i;
    if (!known) contacts.add(p, p - gap * contacts.n, static_cast<std::uint32_t>(i));
  }
}

}  // namespace

double flatness(const Solid& a, const Solid& b) {
  const double round = (a.isLine() ? a.radius : 0) + (b.isLine() ? b.radius : 0);
  return 0.02 * round + 1e-3 * std::min(a.size, b.size);
}

double touchRound(const Solid& a, const Solid& b, const Relative& pose, double reach,
                  Contacts& contacts) {
  const Vec3 u = pose.R.col(1);
  const Line lineA{pose.t - a.halfLength * u, pose.t + a.halfLength * u, a.rounding};
  const Line lineB = lineOf(b, 0);
  const LinePoints closest = closestPoints(lineA, lineB);
  const Vec3 d = closest.onA - closest.onB;
  const double distance = d.norm(), gap = distance - a.rounding - b.rounding;
  const bool clear = distance > kCoincident * (a.size + b.size);
  contacts.n = clear ? Vec3(d / distance) : anyDirection(lineA, lineB, pose.t);
  if (gap > reach) return gap;
  contacts.radiusA = a.rounding;
  contacts.radiusB = b.rounding;
  touchLines(lineA, lineB, kLinesTag, flatness(a, b), contacts);
  return gap;
}

double touchPoint(const Solid& a, const Solid& b, const Relative& pose, Contacts& contacts) {
  const Nearest nearest = b.kind == SolidKind::box        ? nearestOnBox(b, pose.t)
                          : b.kind == SolidKind::cylinder ? nearestOnCylinder(b, pose.t)
                                                          : nearestOnHull(b, pose.t);
  contacts.n = nearest.n;
  contacts.radiusA = a.rounding;
  contacts.radiusB = nearest.radius;
  contacts.count = 0;
  contacts.add(pose.t, nearest.core, kPointTag);
  return nearest.distance - a.rounding;
}

double touchPlane(const Solid& a, const Solid& plane, const Relative& pose, Contacts& contacts) {
  Patch patch;
  facing(a, -(pose.R.transpose() * plane.normal), patch);
  transform(patch, pose);
  contacts.n = plane.normal;
  contacts.radiusA = patch.radius;
  contacts.radiusB = 0;
  contacts.count = 0;
  for (int i = 0; i < patch.count; ++i) {
    const Vec3& p = patch.corners[i].p;
    const Vec3 onPlane = p - (plane.normal.dot(p) - plane.offset) * plane.normal;
    contacts.add(p, onPlane, patch.corners[i].id);
  }
  if (a.isPolyhedron()) addLowCorners(a, pose, plane, contacts);
  return contacts.smallestGap();
}

}  // namespace physics::collision
