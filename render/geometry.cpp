// Unit box, sphere, capsule and cylinder as triangles.
#include "render/geometry.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace render {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::uint32_t countOf(const Geometry& geometry) {
  return static_cast<std::uint32_t>(geometry.vertices.size());
}

void addQuad(Geometry& geometry, std::uint32_t a, std::uint32_t b, std::uint32_t c,
             std::uint32_t d) {
  for (const std::uint32_t index : {a, b, c, a, c, d}) geometry.indices.push_back(index);
}

// Of a polygon that is as far outside the circle of radius 1/2 at its corners as it is within it
// between them.
double cornerRadius(int segments) { return 1 / (1 + std::cos(kPi / segments)); }

// One circle of vertices on the sphere at `latitude`; the first is repeated at the end.
void addRing(Geometry& geometry, int segments, double latitude, float end) {
  for (int i = 0; i <= segments; ++i) {
    const double longitude = 2 * kPi * i / segments;
    const auto x = static_cast<float>(std::cos(latitude) * std::cos(longitude));
    const auto y = static_cast<float>(std::sin(latitude));
    const auto z = static_cast<float>(-std::cos(latitude) * std::sin(longitude));
    const auto r = static_cast<float>(cornerRadius(segments));
    geometry.vertices.push_back({{r * x, r * y, r * z, end}, {x, y, z}, {0, 0}});
  }
}

void joinRings(Geometry& geometry, int segments, std::uint32_t lower, std::uint32_t upper) {
  for (int i = 0; i < segments; ++i) {
    const auto k = static_cast<std::uint32_t>(i);
    addQuad(geometry, lower + k, lower + k + 1, upper + k + 1, upper + k);
  }
}

// Each piece of the last or first ring, which is a pole, has no length.
void joinPole(Geometry& geometry, int segments, std::uint32_t ring, std::uint32_t pole) {
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(segments); ++k) {
    const std::uint32_t from = pole > ring ? k : k + 1, to = pole > ring ? k + 1 : k;
    for (const std::uint32_t index : {ring + from, ring + to, pole + k})
      geometry.indices.push_back(index);
  }
}

// Rings from the south pole up; a capsule repeats the equator, once for each end.
Geometry roundBody(int segments, bool capsule) {
  Geometry geometry;
  const int half = segments / 4;
  const auto stride = static_cast<std::uint32_t>(segments) + 1;
  for (int ring = -half; ring <= 0; ++ring)
    addRing(geometry, segments, kPi / 2 * ring / half, capsule ? -1.0f : 0.0f);
  for (int ring = capsule ? 0 : 1; ring <= half; ++ring)
    addRing(geometry, segments, kPi / 2 * ring / half, capsule ? 1.0f : 0.0f);
  const std::uint32_t rings = countOf(geometry) / stride;
  joinPole(geometry, segments, stride, 0);
  for (std::uint32_t ring = 1; ring + 2 < rings; ++ring)
    joinRings(geometry, segments, ring * stride, (ring + 1) * stride);
  joinPole(geometry, segments, (rings - 2) * stride, (rings - 1) * stride);
  return geometry;
}

// How far out the corners of half a circle in so many pieces are, in radii.
double outOf(int pieces) { return 2 * cornerRadius(2 * pieces); }

// A meridian of a half that faces the viewer, from pole to pole.
struct Meridian {
  std::uint32_t first = 0;
  int pieces = 0;
};

// `at`: 0 at the tube, 1 at the outline. Shares are those of a body seen from across its axis,
// where the middle is 45 degrees from both.
Meridian addMeridian(Geometry& geometry, float end, double at, int pieces, double polesOut) {
  const Meridian meridian{countOf(geometry), pieces};
  const double inner = std::min(2 * at, 1.0), outer = std::max(2 * at - 1, 0.0);
  const auto share = [](double part) { return static_cast<float>(std::sin(kPi / 4 * part)); };
  const std::array<float, 3> shares{share(1 - inner), share(at < 0.5 ? inner : 1 - outer),
                                    share(outer)};
  for (int i = 0; i <= pieces; ++i) {
    const bool pole = i == 0 || i == pieces;
    const double angle = kPi * (static_cast<double>(i) / pieces - 0.5);
    const double out = pole ? polesOut : outOf(pieces);
    geometry.vertices.push_back({{end, pole ? 0.0f : static_cast<float>(std::cos(angle)),
                                  static_cast<float>(std::sin(angle)), static_cast<float>(out)},
                                 shares,
                                 {0, 0}});
  }
  return meridian;
}

bool samePole(const Vertex& a, const Vertex& b) {
  return a.position[1] == 0 && b.position[1] == 0 && a.position[0] == b.position[0] &&
         a.position[2] == b.position[2];
}

// Triangles between two meridians, in turns as their pieces end; none without area at a pole.
// `other`: seen from the viewer, b lies to the other side of a.
void joinMeridians(Geometry& geometry, const Meridian& a, const Meridian& b, bool other) {
  const auto add = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
    const std::vector<Vertex>& v = geometry.vertices;
    if (samePole(v[p], v[q]) || samePole(v[q], v[r]) || samePole(v[r], v[p])) return;
    for (const std::uint32_t index : {p, other ? r : q, other ? q : r})
      geometry.indices.push_back(index);
  };
  for (int i = 0, j = 0; i < a.pieces || j < b.pieces;) {
    const auto p = a.first + static_cast<std::uint32_t>(i);
    const auto q = b.first + static_cast<std::uint32_t>(j);
    const bool ofA = i < a.pieces && (i + 1) * b.pieces <= (j + 1) * a.pieces;
    if (ofA) {
      add(p, p + 1, q);
      ++i;
    } else {
      add(p, q + 1, q);
      ++j;
    }
  }
}

// The sides of a tube are straight lines from pole to pole: its poles lie on it, a ball's are
// corners of its outline as any other. Seen along the axis, half of the outline is the tube's end.
Geometry facing(int segments, bool capsule) {
  Geometry geometry;
  const int strips = segments <= 12 ? 1 : segments <= 24 ? 2 : segments <= 48 ? 4 : 8;
  const int pieces = std::max(2 * strips, segments / 4);
  std::array<Meridian, 2> tube;
  for (const int end : {0, 1}) {
    Meridian last;
    for (int i = 0; i <= strips; ++i) {
      const Meridian next =
          addMeridian(geometry, end == 0 ? -1.0f : 1.0f, static_cast<double>(i) / strips,
                      i == strips ? segments / 2 : pieces, capsule ? 1 : outOf(segments / 2));
      if (i == 0)
        tube[static_cast<std::size_t>(end)] = next;
      else
        joinMeridians(geometry, last, next, end == 1);
      last = next;
    }
  }
  if (capsule) joinMeridians(geometry, tube[0], tube[1], true);
  return geometry;
}

void addCap(Geometry& geometry, int segments, float y) {
  const std::uint32_t center = countOf(geometry);
  const double r = cornerRadius(segments);
  const float normal = y > 0 ? 1.0f : -1.0f;
  geometry.vertices.push_back({{0, y, 0, 0}, {0, normal, 0}, {0, 0}});
  for (int i = 0; i <= segments; ++i) {
    const double angle = 2 * kPi * i / segments;
    const auto x = static_cast<float>(r * std::cos(angle));
    const auto z = static_cast<float>(-r * std::sin(angle));
    geometry.vertices.push_back({{x, y, z, 0}, {0, normal, 0}, {1, 0}});
  }
  for (std::uint32_t i = 1; i <= static_cast<std::uint32_t>(segments); ++i) {
    const std::uint32_t first = center + (y > 0 ? i : i + 1), second = center + (y > 0 ? i + 1 : i);
    for (const std::uint32_t index : {center, first, second}) geometry.indices.push_back(index);
  }
}

// Along the normal of triangle t, as long as twice its area.
Vec3f twiceAreaOf(const std::vector<Vec3f>& positions, const std::vector<std::uint32_t>& triangles,
                  std::size_t t) {
  const Vec3f &a = positions[triangles[3 * t]], &b = positions[triangles[3 * t + 1]],
              &c = positions[triangles[3 * t + 2]];
  return (b - a).cross(c - a);
}

Vec3f unitOrUp(const Vec3f& v) {
  const float length = v.norm();
  return length > 0 ? (v / length).eval() : Vec3f::UnitY();
}

}  // namespace

Geometry unitBox() {
  Geometry geometry;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const std::uint32_t first = countOf(geometry);
      const std::size_t n = static_cast<std::size_t>(axis), u = (n + 1) % 3, v = (n + 2) % 3;
      for (const auto& [a, b] :
           {std::array{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
        Vertex vertex{{0, 0, 0, 0}, {0, 0, 0}, {a, b}};
        vertex.position[n] = side / 2;
        vertex.position[u] = a / 2;
        vertex.position[v] = b / 2;
        vertex.normal[n] = side;
        geometry.vertices.push_back(vertex);
      }
      if (side > 0)
        addQuad(geometry, first, first + 1, first + 2, first + 3);
      else
        addQuad(geometry, first, first + 3, first + 2, first + 1);
    }
  }
  return geometry;
}

Geometry facingBall(int segments) { return facing(segments, false); }

Geometry facingCapsule(int segments) { return facing(segments, true); }

Geometry unitSphere(int segments) { return roundBody(segments, false); }

Geometry unitCapsule(int segments) { return roundBody(segments, true); }

Geometry unitCylinder(int segments) {
  Geometry geometry;
  const auto r = static_cast<float>(cornerRadius(segments));
  for (const float y : {-0.5f, 0.5f}) {
    for (int i = 0; i <= segments; ++i) {
      const double angle = 2 * kPi * i / segments;
      const auto x = static_cast<float>(std::cos(angle)), z = static_cast<float>(-std::sin(angle));
      geometry.vertices.push_back({{r * x, y, r * z, 0}, {x, 0, z}, {2 * y, 0}});
    }
  }
  joinRings(geometry, segments, 0, static_cast<std::uint32_t>(segments) + 1);
  addCap(geometry, segments, -0.5f);
  addCap(geometry, segments, 0.5f);
  return geometry;
}

Geometry geometryOf(const Mesh& mesh) {
  if (mesh.normals.size() != mesh.positions.size() || mesh.indices.size() % 3 != 0)
    throw std::invalid_argument(
        "mesh: one normal per position and three indices per triangle, got " +
        std::to_string(mesh.positions.size()) + " positions, " +
        std::to_string(mesh.normals.size()) + " normals, " + std::to_string(mesh.indices.size()) +
        " indices");
  Geometry geometry;
  geometry.vertices.reserve(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3f &p = mesh.positions[i], &n = mesh.normals[i];
    geometry.vertices.push_back({{p.x(), p.y(), p.z(), 0}, {n.x(), n.y(), n.z()}, {0, 0}});
  }
  for (const std::uint32_t index : mesh.indices)
    if (index >= mesh.positions.size())
      throw std::invalid_argument("mesh: index " + std::to_string(index) + " of " +
                                  std::to_string(mesh.positions.size()) + " vertices");
  geometry.indices = mesh.indices;
  return geometry;
}

std::vector<Vec3f> smoothNormals(const std::vector<Vec3f>& positions,
                                 const std::vector<std::uint32_t>& triangles) {
  std::vector<Vec3f> normals(positions.size(), Vec3f::Zero());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    normals[triangles[i]] += twiceAreaOf(positions, triangles, i / 3);
  for (Vec3f& normal : normals) normal = unitOrUp(normal);
  return normals;
}

std::vector<Vec3f> creasedNormals(const std::vector<Vec3f>& positions,
                                  const std::vector<std::uint32_t>& triangles) {
  std::vector<Vec3f> areas;
  for (std::size_t t = 0; t < triangles.size() / 3; ++t)
    areas.push_back(twiceAreaOf(positions, triangles, t));
  std::vector<std::vector<std::size_t>> around(positions.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) around[triangles[i]].push_back(i / 3);
  std::vector<Vec3f> normals;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Vec3f& own = areas[i / 3];
    Vec3f sum = own;
    for (const std::size_t other : around[triangles[i]])
      if (other != i / 3 && areas[other].dot(own) > 0.5f * areas[other].norm() * own.norm())
        sum += areas[other];
    normals.push_back(unitOrUp(sum));
  }
  return normals;
}

}  // namespace render
