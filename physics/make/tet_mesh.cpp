// Grids of tetrahedra, their faces and edges, found by sorting.
#include "physics/make/tet_mesh.h"

#include <algorithm>
#include <cmath>

namespace physics {
namespace {

// The faces of a tetrahedron of positive volume, counter-clockwise seen from outside.
constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
constexpr int kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr double kFlat = 1e-9;  // volume over the cube of the longest edge

// Corner c of a cell lies at the bits of c: x is 1, y is 2, z is 4. Each list: the tetrahedron in
// the middle, and the four that it leaves. The second list is the first one's mirror image.
constexpr int kCell[2][5][4] = {
    {{0, 3, 5, 6}, {1, 0, 3, 5}, {2, 0, 3, 6}, {4, 0, 5, 6}, {7, 3, 5, 6}},
    {{1, 2, 4, 7}, {0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}}};

struct Face {
  std::array<int, 3> key;  // sorted
  std::array<int, 3> corners;
};

// All faces of all tetrahedra, equal ones side by side.
std::vector<Face> sortedFaces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tets.size());
  for (const std::array<int, 4>& tet : mesh.tets) {
    for (const auto& [a, b, c] : kFaces) {
      Face face{{tet[a], tet[b], tet[c]}, {tet[a], tet[b], tet[c]}};
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& f, const Face& g) { return f.key < g.key; });
  return faces;
}

std::vector<std::array<int, 2>> sortedOnce(std::vector<std::array<int, 2>> edges) {
  for (auto& [a, b] : edges) {
    if (a > b) std::swap(a, b);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::string named(std::size_t tet) { return "tetrahedron " + std::to_string(tet + 1); }

double longestEdge(const TetMesh& mesh, const std::array<int, 4>& tet) {
  double longest = 0;
  for (const auto& [a, b] : kEdges) {
    longest = std::max(longest, (mesh.nodes[tet[a]] - mesh.nodes[tet[b]]).norm());
  }
  return longest;
}

void checkIndices(const TetMesh& mesh) {
  std::vector<bool> used(mesh.nodes.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const int corner : mesh.tets[t]) {
      require(corner >= 0 && corner < static_cast<int>(mesh.nodes.size()),
              named(t) + ": expected vertices in [1, " + std::to_string(mesh.nodes.size()) +
                  "], got " + std::to_string(corner + 1));
      used[corner] = true;
    }
  }
  const auto unused = std::find(used.begin(), used.end(), false);
  require(unused == used.end(), "vertex " + std::to_string(unused - used.begin() + 1) +
                                    " belongs to no tetrahedron, so that it has no mass");
}

void checkFaces(const TetMesh& mesh) {
  const std::vector<Face> faces = sortedFaces(mesh);
  for (std::size_t i = 2; i < faces.size(); ++i) {
    const auto& [a, b, c] = faces[i].key;
    require(faces[i].key != faces[i - 2].key,
            "expected at most two tetrahedra on a face, got more on " + std::to_string(a + 1) +
                " " + std::to_string(b + 1) + " " + std::to_string(c + 1));
  }
}

void addCell(TetMesh& mesh, const std::array<int, 3>& cells, int i, int j, int k) {
  for (const auto& tet : kCell[(i + j + k) % 2]) {
    std::array<int, 4> corners{};
    for (int c = 0; c < 4; ++c) {
      const int x = i + (tet[c] & 1), y = j + (tet[c] >> 1 & 1), z = k + (tet[c] >> 2);
      corners[c] = (z * (cells[1] + 1) + y) * (cells[0] + 1) + x;
    }
    mesh.tets.push_back(corners);
  }
}

}  // namespace

double volumeOf(const TetMesh& mesh, const std::array<int, 4>& tet) {
  const Vec3& a = mesh.nodes[tet[0]];
  return (mesh.nodes[tet[1]] - a).cross(mesh.nodes[tet[2]] - a).dot(mesh.nodes[tet[3]] - a) / 6;
}

double volumeOf(const TetMesh& mesh) {
  double volume = 0;
  for (const std::array<int, 4>& tet : mesh.tets) volume += volumeOf(mesh, tet);
  return volume;
}

TetMesh boxMesh(const Vec3& size, const std::array<int, 3>& cells) {
  require((size.array() > 0).all() && size.allFinite(), "expected a size > 0");
  require(cells[0] > 0 && cells[1] > 0 && cells[2] > 0, "expected at least one cell");
  TetMesh mesh;
  for (int k = 0; k <= cells[2]; ++k) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int i = 0; i <= cells[0]; ++i) {
        const Vec3 part(static_cast<double>(i) / cells[0], static_cast<double>(j) / cells[1],
                        static_cast<double>(k) / cells[2]);
        mesh.nodes.push_back((part - Vec3::Constant(0.5)).cwiseProduct(size));
        if (i < cells[0] && j < cells[1] && k < cells[2]) addCell(mesh, cells, i, j, k);
      }
    }
  }
  orient(mesh);
  return mesh;
}

int orient(TetMesh& mesh) {
  require(!mesh.tets.empty(), "expected at least one tetrahedron");
  checkIndices(mesh);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    require(mesh.nodes[i].allFinite(), "vertex " + std::to_string(i + 1) + " is not finite");
  }
  int inverted = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double volume = volumeOf(mesh, mesh.tets[t]);
    const double edge = longestEdge(mesh, mesh.tets[t]);
    require(std::abs(volume) > kFlat * edge * edge * edge, named(t) + " is flat: it has no volume");
    if (volume > 0) continue;
    std::swap(mesh.tets[t][2], mesh.tets[t][3]);
    ++inverted;
  }
  checkFaces(mesh);
  return inverted;
}

std::vector<std::array<int, 3>> skinOf(const TetMesh& mesh) {
  const std::vector<Face> faces = sortedFaces(mesh);
  std::vector<std::array<int, 3>> skin;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool shared = (i > 0 && faces[i - 1].key == faces[i].key) ||
                        (i + 1 < faces.size() && faces[i + 1].key == faces[i].key);
    if (!shared) skin.push_back(faces[i].corners);
  }
  return skin;
}

std::vector<std::array<int, 2>> edgesOf(const TetMesh& mesh) {
  std::vector<std::array<int, 2>> edges;
  for (const std::array<int, 4>& tet : mesh.tets) {
    for (const auto& [a, b] : kEdges) edges.push_back({tet[a], tet[b]});
  }
  return sortedOnce(std::move(edges));
}

std::vector<std::array<int, 2>> edgesOf(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& [a, b, c] : triangles) {
    edges.push_back({a, b});
    edges.push_back({b, c});
    edges.push_back({c, a});
  }
  return sortedOnce(std::move(edges));
}

}  // namespace physics
