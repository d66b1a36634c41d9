// The surfaces of a picture, uploaded anew for each frame, for the shadow map and for the picture.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/frame.h"
#include "render/gl.h"
#include "render/picture.h"

namespace render {

class Surfaces {
 public:
  explicit Surfaces(const std::string& defines);  // of the program that colours them

  void arrange(const Picture& picture, const Frame& frame);

  bool cast() const;             // something of them goes into a shadow map
  void drawCasters() const;      // opaque and half opaque ones, into a shadow map
  void drawOpaque() const;       // before translucent bodies
  void drawTranslucent() const;  // after them, back to front, the sides that look away first

 private:
  struct SurfaceVertex {
    std::array<float, 3> position, normal, cell;
  };
  struct Batch {
    std::size_t first = 0;
    GLsizei count = 0;
    float depth = 0;
    Color front, back;  // linear
    bool opaque() const { return front.w() >= 1 && back.w() >= 1; }
    bool casts() const { return front.w() >= 0.5f; }
  };

  void append(const Surface& surface);
  void appendFacets(const Surface& surface, const std::vector<Vec3f>& positions);
  void append(const Vec3f& position, const Vec3f& normal, const Vec3f& cell);
  void draw(const Batch& batch) const;
  void drawTriangles(const Batch& batch) const;

  GLuint colorProgram_ = 0, casterProgram_ = 0, array_ = 0, vertexBuffer_ = 0, indexBuffer_ = 0;
  GLint tints_ = -1;
  std::vector<SurfaceVertex> vertices_;
  std::vector<std::uint32_t> indices_;
  std::vector<Batch> batches_;  // the farthest first
};

}  // namespace render
