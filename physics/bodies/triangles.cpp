// Welds the corners of a mesh and finds the neighbours of its triangles.
#include "physics/bodies/triangles.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace physics {
namespace {

bool isBefore(const Vec3& p, const Vec3& q) {
  return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
}

// By vertex, the first of those at its place.
std::vector<int> firstAtPlace(std::span<const Vec3> vertices) {
  std::vector<int> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return isBefore(vertices[i], vertices[j]); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool again = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    first[order[k]] = again ? first[order[k - 1]] : order[k];
  }
  return first;
}

struct Side {
  int from, to, face, edge;
  bool operator<(const Side& s) const {
    return std::tie(from, to, face) < std::tie(s.from, s.to, s.face);
  }
};

void findNeighbours(TriangleMesh& mesh) {
  std::vector<Side> sides;
  for (int f = 0; f < static_cast<int>(mesh.faces.size()); ++f) {
    const auto& v = mesh.faces[f].vertices;
    for (int k = 0; k < 3; ++k) sides.push_back({v[k], v[(k + 1) % 3], f, k});
  }
  std::sort(sides.begin(), sides.end());
  for (const Side& side : sides) {
    const auto across =
        std::lower_bound(sides.begin(), sides.end(), Side{side.to, side.from, 0, 0});
    const bool found = across != sides.end() && across->from == side.to && across->to == side.from;
    if (found) mesh.faces[side.face].neighbours[side.edge] = across->face;
  }
}

}  // namespace

std::shared_ptr<const TriangleMesh> makeTriangleMesh(
    std::span<const Vec3> vertices, std::span<const std::array<int, 3>> triangles) {
  for (const Vec3& p : vertices) require(p.allFinite(), "triangles: a vertex is not finite");
  const std::vector<int> first = firstAtPlace(vertices);
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices.assign(vertices.begin(), vertices.end());
  for (const std::array<int, 3>& triangle : triangles) {
    TriangleMesh::Face face;
    for (int k = 0; k < 3; ++k) {
      require(triangle[k] >= 0 && triangle[k] < static_cast<int>(vertices.size()),
              "triangles: no vertex " + std::to_string(triangle[k]));
      face.vertices[k] = first[triangle[k]];
    }
    const Vec3 &a = vertices[face.vertices[0]], &b = vertices[face.vertices[1]],
               &c = vertices[face.vertices[2]];
    const Vec3 cross = (b - a).cross(c - a);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    if (!(cross.norm() > 1e-9 * longest * longest)) continue;
    face.normal = cross.normalized();
    mesh->faces.push_back(face);
  }
  require(!mesh->faces.empty(), "triangles: at least one with an area is needed");
  findNeighbours(*mesh);
  return mesh;
}

}  // namespace physics
