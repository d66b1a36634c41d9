// The instances of a picture, sorted into instanced draws, for the shadow map and for the picture.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "render/frame.h"
#include "render/geometry.h"
#include "render/gl.h"
#include "render/picture.h"
#include "render/still_casters.h"

namespace render {

class Bodies {
 public:
  explicit Bodies(const std::string& defines);  // of the program that colours them

  // Sorts and uploads the instances: opaque ones by geometry and front to back, then translucent
  // ones back to front. Ties keep the order of the picture.
  void arrange(const Picture& picture, const Frame& frame);

  // Opaque and half opaque ones, in the order of the picture; none where it has no shadows.
  const std::vector<Caster>& casters() const { return casters_; }
  void drawCasters(std::span<const std::size_t> which);  // into a shadow map
  void draw() const;  // all, into a framebuffer of premultiplied colour

 private:
  struct Shape {  // a geometry on the GPU
    GLuint array = 0, vertices = 0, indices = 0;
    GLsizei count = 0;
    bool closed = true;      // its back is never seen
    bool facing = false;     // the half that faces the viewer, of a ball or a capsule
    std::size_t upload = 0;  // the how many-th
  };
  struct Kept {  // holding the mesh keeps its address from being used again
    std::shared_ptr<const Mesh> mesh;
    std::size_t shape = 0;
    bool used = false;
  };
  struct InstanceData {
    std::array<float, 4> place, turn, scale, tint;
  };
  struct Sorted {
    std::size_t shape = 0, instance = 0;
    float depth = 0;
    bool opaque = true, large = false;
  };
  struct Batch {
    std::size_t shape = 0, first = 0;
    GLsizei count = 0;
    bool opaque = true;
  };

  Shape upload(const Geometry& geometry, bool closed);
  std::size_t shapeOf(const Instance& instance, float pixels);
  std::size_t shapeOfMesh(const std::shared_ptr<const Mesh>& mesh);
  void dropUnusedMeshes();
  void sortInstances(const Picture& picture, const Frame& frame);
  static InstanceData dataOf(const Instance& instance);
  void findCasters(const Picture& picture, const Frame& frame);
  void fillBatches(const Picture& picture);
  void cullBack(const Batch& batch) const;
  void drawBatch(const Batch& batch, GLuint instances) const;

  GLuint colorProgram_ = 0, casterProgram_ = 0, instanceBuffer_ = 0, casterBuffer_ = 0;
  GLuint facingColorProgram_ = 0, facingCasterProgram_ = 0;
  std::size_t uploads_ = 0;
  std::vector<Shape> shapes_;  // box, then the levels of the round ones, then meshes
  std::unordered_map<const Mesh*, Kept> meshes_;
  std::vector<std::size_t> freeShapes_;
  std::vector<Sorted> sorted_;
  std::vector<InstanceData> data_;
  std::vector<Batch> batches_;
  std::vector<Caster> casters_;
};

}  // namespace render
