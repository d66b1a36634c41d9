// A grid cut to the inside of a surface, and drawn to it.
#include "physics/make/tet_fill.h"

#include <algorithm>
#include <cmath>

#include "physics/bodies/triangles.h"
#include "physics/make/matter.h"

namespace physics {
namespace {

constexpr double kLeft = 0.2;  // of a tetrahedron's volume: what moving its corners leaves at least
constexpr int kRounds = 3;     // over the corners: one that could not move may later

// Which points are inside of a closed surface: from where a line along x leaves it once more often
// than it enters it. Triangles are kept by the squares across x that they reach into.
class Inside {
 public:
  Inside(const TriangleMesh& surface, double pitch, const Vec3& low,
         const std::array<int, 3>& cells)
      : surface_(surface), pitch_(pitch), low_(low), cells_(cells) {
    faces_.resize(static_cast<std::size_t>(cells[1]) * static_cast<std::size_t>(cells[2]));
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const auto& [a, b, c] = surface.faces[f].vertices;
      const std::array<Vec3, 3> p{surface.vertices[a], surface.vertices[b], surface.vertices[c]};
      const Vec3 least = p[0].cwiseMin(p[1]).cwiseMin(p[2]);
      const Vec3 most = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
      for (int y = square(1, least.y()); y <= square(1, most.y()); ++y) {
        for (int z = square(2, least.z()); z <= square(2, most.z()); ++z) {
          faces_[at(y, z)].push_back(static_cast<int>(f));
        }
      }
    }
  }

  bool has(const Vec3& point) const {
    // Beside corners and edges of what is built on the grid itself.
    const Vec3 from = point + 1e-9 * pitch_ * Vec3(0, 1, std::sqrt(2.0));
    int leaves = 0;
    for (const int f : faces_[at(square(1, from.y()), square(2, from.z()))]) {
      leaves += leavesBy(surface_.faces[f].vertices, from);
    }
    return leaves > 0;
  }

 private:
  int square(int axis, double x) const {
    return std::clamp(static_cast<int>((x - low_[axis]) / pitch_), 0, cells_[axis] - 1);
  }
  std::size_t at(int y, int z) const { return static_cast<std::size_t>(y * cells_[2] + z); }

  // Twice the area that the edge spans with a line: the same but for its sign seen from both sides.
  double span(int i, int j, const Vec3& from) const {
    if (i > j) return -span(j, i, from);
    const Vec3 p = surface_.vertices[i] - from, q = surface_.vertices[j] - from;
    return p.y() * q.z() - q.y() * p.z();
  }

  // 1, or -1 where it enters, or 0 where it passes beside it.
  int leavesBy(const std::array<int, 3>& corner, const Vec3& from) const {
    const double ab = span(corner[0], corner[1], from), bc = span(corner[1], corner[2], from),
                 ca = span(corner[2], corner[0], from);
    const bool leaves = ab > 0 && bc > 0 && ca > 0;
    if (!leaves && !(ab < 0 && bc < 0 && ca < 0)) return 0;
    const double x =
        (bc * surface_.vertices[corner[0]].x() + ca * surface_.vertices[corner[1]].x() +
         ab * surface_.vertices[corner[2]].x()) /
        (ab + bc + ca);
    return x > from.x() ? (leaves ? 1 : -1) : 0;
  }

  const TriangleMesh& surface_;
  double pitch_;
  Vec3 low_;
  std::array<int, 3> cells_;
  std::vector<std::vector<int>> faces_;
};

// Ericson, Real-Time Collision Detection, 5.1.5.
Vec3 nearestOn(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp);
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  return a + vb / (va + vb + vc) * ab + vc / (va + vb + vc) * ac;
}

Vec3 nearestOn(const TriangleMesh& surface, const Vec3& point) {
  Vec3 best = point;
  double least = std::numeric_limits<double>::infinity();
  for (const TriangleMesh::Face& face : surface.faces) {
    const Vec3 q = nearestOn(surface.vertices[face.vertices[0]], surface.vertices[face.vertices[1]],
                             surface.vertices[face.vertices[2]], point);
    const double square = (q - point).squaredNorm();
    if (square < least) least = square, best = q;
  }
  return best;
}

void checkClosed(const TriangleMesh& surface) {
  int open = 0;
  for (const TriangleMesh::Face& face : surface.faces) {
    open += static_cast<int>(std::count(face.neighbours.begin(), face.neighbours.end(), -1));
  }
  require(open == 0, "expected a closed surface whose faces are counter-clockwise from outside, " +
                         std::to_string(open) + " of its edges are open");
}

struct Bounds3 {
  Vec3 low, high;
};
Bounds3 boundsOf(const TriangleMesh& surface) {
  const Vec3& any = surface.vertices[surface.faces[0].vertices[0]];
  Bounds3 bounds{any, any};
  for (const TriangleMesh::Face& face : surface.faces) {
    for (const int i : face.vertices) {
      bounds.low = bounds.low.cwiseMin(surface.vertices[i]);
      bounds.high = bounds.high.cwiseMax(surface.vertices[i]);
    }
  }
  return bounds;
}

// Without the nodes that belong to no tetrahedron.
void dropUnused(TetMesh& mesh) {
  std::vector<int> place(mesh.nodes.size(), -1);
  std::vector<Vec3> kept;
  for (std::array<int, 4>& tet : mesh.tets) {
    for (int& corner : tet) {
      if (place[corner] < 0) {
        place[corner] = static_cast<int>(kept.size());
        kept.push_back(mesh.nodes[corner]);
      }
      corner = place[corner];
    }
  }
  mesh.nodes = std::move(kept);
}

// Moves a corner as far towards `to` as its tetrahedra allow.
void move(TetMesh& mesh, const std::vector<int>& tets, const std::vector<double>& whole, int corner,
          const Vec3& to) {
  const Vec3 from = mesh.nodes[corner];
  for (const double part : {1.0, 0.75, 0.5, 0.25}) {
    mesh.nodes[corner] = from + part * (to - from);
    const bool fits = std::all_of(tets.begin(), tets.end(), [&](int t) {
      return volumeOf(mesh, mesh.tets[t]) >= kLeft * whole[t];
    });
    if (fits) return;
  }
  mesh.nodes[corner] = from;
}

void drawToSurface(TetMesh& mesh, const TriangleMesh& surface) {
  std::vector<std::vector<int>> tetsAt(mesh.nodes.size());
  std::vector<double> whole;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    whole.push_back(volumeOf(mesh, mesh.tets[t]));
    for (const int corner : mesh.tets[t]) tetsAt[corner].push_back(static_cast<int>(t));
  }
  std::vector<bool> isOutside(mesh.nodes.size());
  for (const std::array<int, 3>& triangle : skinOf(mesh)) {
    for (const int corner : triangle) isOutside[corner] = true;
  }
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      if (!isOutside[i]) continue;
      const Vec3 to = nearestOn(surface, mesh.nodes[i]);
      move(mesh, tetsAt[i], whole, static_cast<int>(i), to);
    }
  }
}

}  // namespace

TetMesh fillMesh(std::span<const Vec3> vertices, std::span<const std::array<int, 3>> triangles,
                 int cells) {
  const auto surface = makeTriangleMesh(vertices, triangles);
  checkClosed(*surface);
  const auto [low, high] = boundsOf(*surface);
  const double pitch = (high - low).maxCoeff() / cells;
  std::array<int, 3> counts{};
  for (int k = 0; k < 3; ++k) {
    counts[k] = std::max(1, static_cast<int>(std::ceil((high[k] - low[k]) / pitch - 1e-9)));
  }
  TetMesh mesh = boxMesh(pitch * Vec3(counts[0], counts[1], counts[2]), counts);
  for (Vec3& node : mesh.nodes) node += 0.5 * (low + high);
  const Inside inside(*surface, pitch, mesh.nodes[0], counts);
  std::erase_if(mesh.tets, [&](const std::array<int, 4>& tet) {
    const Vec3 middle =
        (mesh.nodes[tet[0]] + mesh.nodes[tet[1]] + mesh.nodes[tet[2]] + mesh.nodes[tet[3]]) / 4;
    return !inside.has(middle);
  });
  require(!mesh.tets.empty(), "expected something inside of the surface: ask for more cells");
  dropUnused(mesh);
  require(mesh.nodes.size() <= static_cast<std::size_t>(kMostBodies),
          "expected at most " + std::to_string(kMostBodies) + " points, got " +
              std::to_string(mesh.nodes.size()) + ": ask for fewer cells");
  drawToSurface(mesh, *surface);
  return mesh;
}

// Each shell of the cube becomes a shell of the ball.
TetMesh ballMesh(double radius, int cells) {
  TetMesh mesh = boxMesh(Vec3::Constant(2 * radius), {cells, cells, cells});
  for (Vec3& node : mesh.nodes) {
    const double length = node.norm();
    if (length > 0) node *= node.cwiseAbs().maxCoeff() / length;
  }
  return mesh;
}

}  // namespace physics
