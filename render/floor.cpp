// One square around the focus, as wide as the ground is seen.
#include "render/floor.h"

#include "render/shaders.h"

namespace render {

Floor::Floor(const std::string& defines)
    : program_(makeProgram(kFloorVertex, kFloorFragment, defines)), array_(makeVertexArray()) {}

void Floor::draw() const {
  glUseProgram(program_);
  glBindVertexArray(array_);
  glEnable(GL_DEPTH_CLAMP);  // it reaches beyond the planes that enclose the bodies
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_DEPTH_CLAMP);
}

}  // namespace render
