// What the lights of an exposure reach: the key light and points of the sky, as tiles of one map.
#pragma once

#include <vector>

#include "render/bodies.h"
#include "render/casters.h"
#include "render/frame.h"
#include "render/renderer.h"
#include "render/surfaces.h"

namespace render {

class LightMaps {
 public:
  explicit LightMaps(int tileSize);

  // Leaves the map bound to its texture unit, and the frame's block in `uniforms`, which it uses.
  void draw(Bodies& bodies, const Surfaces& surfaces, const Frame& frame, GLuint uniforms,
            DrawCounts& counts);

 private:
  int tile_ = 0;
  DepthMap map_;
};

}  // namespace render
