// The arrays of a glTF model: bytes of one buffer, and what says how to read them.
#pragma once

#include <tiny_gltf.h>

#include <map>
#include <string>
#include <vector>

#include "render/geometry.h"
#include "render/picture.h"

namespace app {

class GltfModel {
 public:
  explicit GltfModel(tinygltf::Model& model) : model_(model) { model_.buffers.resize(1); }

  // Index of the accessor; `type` such as TINYGLTF_TYPE_VEC3. Least and largest are told where
  // asked for, as positions and times must have them.
  int add(const std::vector<float>& numbers, int type, bool withBounds = false);
  int add(const std::vector<std::uint32_t>& indices);
  int add(const std::vector<render::Vec3f>& vectors, bool withBounds = false);

  // Each look is there once.
  int material(const render::Color& color, bool bothSides);
  int mesh(const render::Instance& look);

 private:
  struct Shape {  // triangles on the buffer
    int positions = 0, normals = 0;
    std::vector<int> indices;  // one, or two where every other octant is darker
  };
  const Shape& shape(const render::Instance& look);
  int view(const void* bytes, std::size_t count, int target);

  tinygltf::Model& model_;
  std::map<std::vector<float>, int> materials_;
  std::map<std::pair<const void*, std::vector<float>>, Shape> shapes_;
  std::map<std::pair<const Shape*, int>, int> meshes_;
};

}  // namespace app
