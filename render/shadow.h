// The shadow map, and from it the soft shadow on the ground.
//
// Bodies compare depths in the map. The ground needs no comparison, since all that is in the map
// lies above it: a blurred picture of what is covered is its shadow, at one plain fetch a pixel.
#pragma once

#include "render/bodies.h"
#include "render/gl.h"
#include "render/surfaces.h"

namespace render {

class Shadow {
 public:
  explicit Shadow(int size);

  // Leaves the map and the masks bound to their texture units.
  void draw(const Bodies& bodies, const Surfaces& surfaces, const Frame& frame) const;

 private:
  struct Layer {
    GLuint texture = 0, framebuffer = 0;
    int size = 0;
  };
  static Layer makeLayer(int size);
  static void filter(GLuint program, GLuint source, const Layer& target, const Bounds& bounds);
  void drawMasks(const Bounds& bounds) const;

  int size_ = 0;
  GLuint map_ = 0, mapFramebuffer_ = 0, compare_ = 0, array_ = 0;
  GLuint maskProgram_ = 0, sharpProgram_ = 0, wideProgram_ = 0, acrossProgram_ = 0, upProgram_ = 0;
  Layer mask_, sharp_, wide_, wideAcross_;
};

}  // namespace render
