// The shadow map, and from it the soft shadow on the ground.
//
// Bodies compare depths in the map. The ground needs no comparison, since all that is in the map
// lies above it: a blurred picture of what is covered is its shadow, at one plain fetch a pixel.
//
// What has not moved since the last picture is copied from a layer, or where nothing has, map and
// masks stay as they are. The picture comes out the same, bit for bit.
#pragma once

#include "render/bodies.h"
#include "render/bounds.h"
#include "render/casters.h"
#include "render/gl.h"
#include "render/renderer.h"
#include "render/still_casters.h"
#include "render/surfaces.h"

namespace render {

class Shadow {
 public:
  explicit Shadow(int size);

  // Leaves the map and the masks bound to their texture units. Adds what it did to `counts`.
  void draw(Bodies& bodies, const Surfaces& surfaces, const Frame& frame, DrawCounts& counts);

 private:
  struct Layer {
    GLuint texture = 0, framebuffer = 0;
    int size = 0;
  };
  static Layer makeLayer(int size);
  static void filter(GLuint program, GLuint source, const Layer& target, const Bounds& bounds);
  void drawMap(const ShadowWork& work, Bodies& bodies, const Surfaces& surfaces,
               DrawCounts& counts);
  void drawMasks(const Bounds& bounds) const;

  int size_ = 0;
  StillCasters still_;
  DepthMap map_, stillMap_;  // the second is made when it is first needed
  bool masksHold_ = false;
  Bounds maskBounds_;
  GLuint compare_ = 0, array_ = 0;
  GLuint maskProgram_ = 0, sharpProgram_ = 0, wideProgram_ = 0, acrossProgram_ = 0, upProgram_ = 0;
  Layer mask_, sharp_, wide_, wideAcross_;
};

}  // namespace render
