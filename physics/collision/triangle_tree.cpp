// The bounds of triangles in a tree.
#include "physics/collision/triangle_tree.h"

#include <algorithm>

namespace physics::collision {

TriangleTree::TriangleTree(std::shared_ptr<const TriangleMesh> mesh) : mesh_(std::move(mesh)) {
  for (const TriangleMesh::Face& face : mesh_->faces) {
    const Vec3 &a = mesh_->vertices[face.vertices[0]], &b = mesh_->vertices[face.vertices[1]],
               &c = mesh_->vertices[face.vertices[2]];
    tree_.add({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)}, false);
  }
  tree_.balance();
}

void TriangleTree::find(const Bounds& bounds, std::vector<int>& found) const {
  found.clear();
  tree_.find(bounds, found);
  std::sort(found.begin(), found.end());
}

std::size_t TriangleTree::bytes() const {
  return tree_.bytes() + mesh_->vertices.capacity() * sizeof(Vec3) +
         mesh_->faces.capacity() * sizeof(TriangleMesh::Face);
}

}  // namespace physics::collision
