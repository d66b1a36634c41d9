// Depth maps and the state to draw them.
#include "render/casters.h"

namespace render {

DepthMap makeDepthMap(int size, const char* name) {
  DepthMap map;
  map.texture = makeTexture(GL_DEPTH_COMPONENT16, size, size, GL_NEAREST);
  glGenFramebuffers(1, &map.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, map.texture, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  requireCompleteFramebuffer(name);
  return map;
}

GLuint makeDepthSampler() {
  GLuint sampler = 0;
  glGenSamplers(1, &sampler);
  const auto set = [sampler](GLenum name, GLenum value) {
    glSamplerParameteri(sampler, name, static_cast<GLint>(value));
  };
  set(GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  set(GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  set(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  set(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  set(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  set(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return sampler;
}

CasterState::CasterState() {
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 2.0f);
}

CasterState::~CasterState() {
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace render
