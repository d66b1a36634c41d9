// Helpers of the collision tests.
#include "tests/physics/collision/scene_of_two.h"

#include <cmath>

namespace physics::testing {
namespace {

Vec3 furthest(const PointShape&, const Vec3&) { return Vec3::Zero(); }
Vec3 furthest(const Plane&, const Vec3&) {
  throw std::logic_error("a plane has no furthest point");
}
Vec3 furthest(const Compound&, const Vec3&) {
  throw std::logic_error("a compound has no furthest point here");
}
Vec3 furthest(const Triangles&, const Vec3&) {
  throw std::logic_error("triangles have no furthest point here");
}
Vec3 furthest(const Sphere& s, const Vec3& d) { return s.radius * d.normalized(); }
Vec3 furthest(const Box& box, const Vec3& d) {
  return 0.5 * box.size.cwiseProduct(Vec3((d.array() < 0).select(-Vec3::Ones(), Vec3::Ones())));
}
Vec3 furthest(const Capsule& c, const Vec3& d) {
  return Vec3(0, d.y() < 0 ? -c.length / 2 : c.length / 2, 0) + c.radius * d.normalized();
}
Vec3 furthest(const Cylinder& c, const Vec3& d) {
  const Vec2 flat(d.x(), d.z());
  const Vec2 rim = flat.norm() > 0 ? Vec2(c.radius * flat.normalized()) : Vec2(0, 0);
  return {rim.x(), d.y() < 0 ? -c.length / 2 : c.length / 2, rim.y()};
}
Vec3 furthest(const Convex& c, const Vec3& d) {
  Vec3 best = c.hull->vertices[0];
  for (const Vec3& p : c.hull->vertices) {
    if (p.dot(d) > best.dot(d)) best = p;
  }
  return best;
}

Collider colliderOf(const Shape& a, const Shape& b) {
  Collider collider;
  collider.add(1, a, !std::holds_alternative<Plane>(a));
  collider.add(2, b, std::holds_alternative<Plane>(a));
  return collider;
}

}  // namespace

Convex hullOf(std::span<const Vec3> points) { return {makeHull(points).hull}; }

Convex wedge() {
  const std::vector<Vec3> points = {{-.3, -.2, -.25}, {.3, -.2, -.25}, {-.3, -.2, .25},
                                    {.3, -.2, .25},   {-.3, .25, -.2}, {-.3, .25, .2}};
  return hullOf(points);
}

Convex ball(int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {  // a spiral from pole to pole
    const double y = 1 - (2.0 * i + 1) / count, turn = 2.399963229728653 * i;
    const double across = std::sqrt(1 - y * y);
    points.emplace_back(0.4 * across * std::cos(turn), 0.4 * y, 0.4 * across * std::sin(turn));
  }
  return hullOf(points);
}

std::vector<Named> shapes() {
  return {{"point", PointShape{}},
          {"sphere", Sphere{0.3}},
          {"capsule", Capsule{0.15, 0.5}},
          {"cylinder", Cylinder{0.25, 0.5}},
          {"box", Box{Vec3(0.5, 0.4, 0.6)}},
          {"wedge", wedge()},
          {"ball", ball(40)},
          {"plane", Plane{Vec3(0, 1, 0), 0.1}}};
}

std::vector<Manifold> meet(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB,
                           double margin) {
  Collider collider = colliderOf(a, b);
  const std::vector<Pose> poses = {Pose{}, poseA, poseB};
  const auto found = collider.find(poses, poses, margin);
  return {found.begin(), found.end()};
}

double distanceOf(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB) {
  return colliderOf(a, b).distance(1, poseA, 2, poseB);
}

Point place(const Manifold& m, int index, std::span<const Pose> poses) {
  const ContactPoint& p = m.points[index];
  const Pose &a = poses[m.a], &b = poses[m.b];
  Point result;
  result.n = b.q * m.normal;
  result.onA = a.x + a.q * p.coreA - p.radiusA * result.n;
  result.onB = b.x + b.q * p.coreB + p.radiusB * result.n;
  result.gap = (result.onA - result.onB).dot(result.n);
  return result;
}

double smallestGap(const Manifold& m, std::span<const Pose> poses) {
  double smallest = 1e300;
  for (int i = 0; i < m.count; ++i) smallest = std::min(smallest, place(m, i, poses).gap);
  return smallest;
}

Vec3 supportOf(const Shape& shape, const Pose& pose, const Vec3& d) {
  const Vec3 local = pose.q.conjugate() * d;
  return pose.x + pose.q * std::visit([&](const auto& s) { return furthest(s, local); }, shape);
}

double separation(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB,
                  const Vec3& n) {
  const double low = n.dot(supportOf(a, poseA, -n));
  if (const auto* plane = std::get_if<Plane>(&b)) {
    const Vec3 up = poseB.q * plane->normal.normalized();
    return low - n.dot(poseB.x + up * plane->offset / plane->normal.norm());  // n is up
  }
  return low - n.dot(supportOf(b, poseB, n));
}

double Random::number(double low, double high) {
  return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
}

Vec3 Random::vector(double low, double high) {
  Vec3 v;
  for (double& component : v) component = number(low, high);
  return v;
}

Vec3 Random::direction() {
  while (true) {
    const Vec3 d = vector(-1, 1);
    if (d.norm() > 0.1 && d.norm() < 1) return d.normalized();
  }
}

Vec3 Random::within(double furthest) {
  const double distance = furthest * number(0, 1);
  return distance * direction();
}

Quat Random::rotation() {
  const double angle = number(0, 3.14);
  return Quat(Eigen::AngleAxisd(angle, direction()));
}

Quat Random::lean(double low, double high) {
  const double degrees = number(low, high);
  return turned(direction(), degrees);
}

Quat turned(const Vec3& axis, double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * 3.14159265358979324 / 180, axis.normalized()));
}

}  // namespace physics::testing
