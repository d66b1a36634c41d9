// Meshes of hulls and of ground, with their normals.
#include "scenes/view/shape_mesh.h"

#include <algorithm>
#include <limits>

#include "physics/bodies/triangles.h"

namespace scenes {
namespace {

using physics::Vec3;

constexpr double kSmooth = 0.8;  // cosine: faces that turn less at a corner share a normal

void addFaces(const physics::Hull& hull, render::Mesh& mesh) {
  for (const physics::Hull::Face& face : hull.faces) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const int vertex : face.vertices) {
      mesh.positions.push_back(hull.vertices[vertex].cast<float>());
      mesh.normals.push_back(face.normal.cast<float>());
    }
    for (std::uint32_t i = 2; i < face.vertices.size(); ++i) {
      mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
    }
  }
}

double areaOf(const physics::TriangleMesh& ground, const physics::TriangleMesh::Face& face) {
  const Vec3 &a = ground.vertices[face.vertices[0]], &b = ground.vertices[face.vertices[1]],
             &c = ground.vertices[face.vertices[2]];
  return 0.5 * (b - a).cross(c - a).norm();
}

void addTriangles(const physics::TriangleMesh& ground, render::Mesh& mesh) {
  std::vector<std::vector<int>> facesAt(ground.vertices.size());
  for (int f = 0; f < static_cast<int>(ground.faces.size()); ++f) {
    for (const int vertex : ground.faces[f].vertices) facesAt[vertex].push_back(f);
  }
  for (const physics::TriangleMesh::Face& face : ground.faces) {
    for (const int vertex : face.vertices) {
      Vec3 normal = Vec3::Zero();
      for (const int f : facesAt[vertex]) {
        const physics::TriangleMesh::Face& other = ground.faces[f];
        if (other.normal.dot(face.normal) > kSmooth) normal += areaOf(ground, other) * other.normal;
      }
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(ground.vertices[vertex].cast<float>());
      mesh.normals.push_back(normal.normalized().cast<float>());
    }
  }
}

}  // namespace

std::shared_ptr<const render::Mesh> meshOf(const physics::Shape& shape) {
  const auto* convex = std::get_if<physics::Convex>(&shape);
  const auto* ground = std::get_if<physics::Triangles>(&shape);
  if (convex == nullptr && ground == nullptr) return nullptr;
  auto mesh = std::make_shared<render::Mesh>();
  if (convex != nullptr) addFaces(*convex->hull, *mesh);
  if (ground != nullptr) addTriangles(*ground->mesh, *mesh);
  return mesh;
}

double lowestOf(const physics::Triangles& ground, const physics::Pose& pose) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : ground.mesh->vertices) {
    lowest = std::min(lowest, (pose.x + pose.q * vertex).y());
  }
  return lowest;
}

}  // namespace scenes
