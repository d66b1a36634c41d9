// The ground: a grid that gives scale, with the shadow of the bodies, fading into the background.
// Its lines smooth themselves, so it is drawn without multisampling, before the bodies.
#pragma once

#include <string>

#include "render/gl.h"

namespace render {

class Floor {
 public:
  explicit Floor(const std::string& defines);  // of the program that colours them
  void draw() const;  // into a framebuffer that is cleared to the background

 private:
  GLuint program_ = 0, array_ = 0;
};

}  // namespace render
