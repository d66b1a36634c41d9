// A mesh of triangles and the tree of their bounds: which of them are near a box.
#pragma once

#include <memory>
#include <vector>

#include "physics/bodies/triangles.h"
#include "physics/collision/broad_phase.h"

namespace physics::collision {

class TriangleTree {
 public:
  explicit TriangleTree(std::shared_ptr<const TriangleMesh> mesh);

  const TriangleMesh& mesh() const { return *mesh_; }
  // Those whose bounds overlap `bounds` (frame of the mesh), in order.
  void find(const Bounds& bounds, std::vector<int>& found) const;
  std::size_t bytes() const;

 private:
  std::shared_ptr<const TriangleMesh> mesh_;
  BroadPhase tree_;
};

}  // namespace physics::collision
