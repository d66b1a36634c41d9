// How casters are drawn into a depth map, whatever map it is.
#pragma once

#include "render/gl.h"

namespace render {

// A map of depths and the framebuffer to draw it in.
struct DepthMap {
  GLuint texture = 0, framebuffer = 0;
};
DepthMap makeDepthMap(int size, const char* name);

// Compares with the depth that is asked for: 1 where that is nearer.
GLuint makeDepthSampler();

// The state of drawing casters, as long as it lives: what is in front of the map is clamped to it,
// and what is drawn lies a little deeper than it is, so that no face shades itself.
class CasterState {
 public:
  CasterState();
  ~CasterState();
  CasterState(const CasterState&) = delete;
  CasterState& operator=(const CasterState&) = delete;
};

}  // namespace render
