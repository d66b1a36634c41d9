// Draws the casters from the light and filters what they cover.
#include "render/shadow.h"

#include <algorithm>

#include "render/shaders.h"

namespace render {
namespace {

constexpr int kReach = 8;  // texels of a mask that the filters carry a shadow beyond its caster

ShadowView shadowViewOf(const Frame& frame) {
  ShadowView view{};
  std::copy_n(frame.block.toShadow.data(), 16, view.begin());
  view[16] = frame.block.ground.x();
  view[17] = frame.block.ground.y();
  return view;
}

}  // namespace

Shadow::Shadow(int size) : size_(size) {
  map_ = makeMap();
  glGenSamplers(1, &compare_);
  const auto set = [this](GLenum name, GLenum value) {
    glSamplerParameteri(compare_, name, static_cast<GLint>(value));
  };
  set(GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  set(GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  set(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  set(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  set(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  set(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  array_ = makeVertexArray();
  maskProgram_ = makeProgram(kViewportVertex, kMaskFragment);
  sharpProgram_ = makeProgram(kViewportVertex, kSharpFragment);
  wideProgram_ = makeProgram(kViewportVertex, kWideFragment);
  acrossProgram_ = makeProgram(kViewportVertex, kBlurFragment);
  glUniform2f(glGetUniformLocation(acrossProgram_, "direction"), 1, 0);
  upProgram_ = makeProgram(kViewportVertex, kBlurFragment);
  glUniform2f(glGetUniformLocation(upProgram_, "direction"), 0, 1);
  mask_ = makeLayer(size / 2);
  sharp_ = makeLayer(size / 2);
  wide_ = makeLayer(size / 8);
  wideAcross_ = makeLayer(size / 8);
}

Shadow::Map Shadow::makeMap() const {
  Map map;
  map.texture = makeTexture(GL_DEPTH_COMPONENT16, size_, size_, GL_NEAREST);
  glGenFramebuffers(1, &map.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, map.texture, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  requireCompleteFramebuffer("the shadow map");
  return map;
}

Shadow::Layer Shadow::makeLayer(int size) {
  Layer layer;
  layer.size = size;
  layer.texture = makeTexture(GL_RG8, size, size, GL_LINEAR);
  layer.framebuffer = makeFramebuffer(layer.texture, "the shadow on the ground");
  return layer;
}

void Shadow::filter(GLuint program, GLuint source, const Layer& target, const Bounds& bounds) {
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  glViewport(0, 0, target.size, target.size);
  glClear(GL_COLOR_BUFFER_BIT);
  cutTo(bounds, target.size, target.size, kReach);
  glUseProgram(program);
  bindTexture(kSourceUnit, GL_TEXTURE_2D, source);
  drawWholeViewport();
  uncut();
}

void Shadow::drawMasks(const Bounds& bounds) const {
  glBindVertexArray(array_);
  glClearColor(0, 0, 0, 0);
  filter(maskProgram_, map_.texture, mask_, bounds);
  filter(sharpProgram_, mask_.texture, sharp_, bounds);
  filter(wideProgram_, mask_.texture, wide_, bounds);
  filter(acrossProgram_, wide_.texture, wideAcross_, bounds);
  filter(upProgram_, wideAcross_.texture, wide_, bounds);
}

void Shadow::drawMap(const ShadowWork& work, Bodies& bodies, const Surfaces& surfaces,
                     DrawCounts& counts) {
  if (work.newLayer && stillMap_.texture == 0) stillMap_ = makeMap();
  glViewport(0, 0, size_, size_);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5f, 2.0f);
  if (work.newLayer) {
    glBindFramebuffer(GL_FRAMEBUFFER, stillMap_.framebuffer);
    glClear(GL_DEPTH_BUFFER_BIT);
    bodies.drawCasters(work.still);
    counts.casters += static_cast<std::int64_t>(work.still.size());
  }
  glBindFramebuffer(GL_FRAMEBUFFER, map_.framebuffer);
  if (work.fromLayer) {
    glCopyImageSubData(stillMap_.texture, GL_TEXTURE_2D, 0, 0, 0, 0, map_.texture, GL_TEXTURE_2D, 0,
                       0, 0, 0, size_, size_, 1);
  } else {
    glClear(GL_DEPTH_BUFFER_BIT);
  }
  bodies.drawCasters(work.moving);
  surfaces.drawCasters();
  counts.casters += static_cast<std::int64_t>(work.moving.size());
  ++counts.shadowMaps;
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
}

void Shadow::draw(Bodies& bodies, const Surfaces& surfaces, const Frame& frame,
                  DrawCounts& counts) {
  const ShadowWork work = still_.next(bodies.casters(), shadowViewOf(frame), surfaces.cast());
  if (!work.nothing) {
    drawMap(work, bodies, surfaces, counts);
    masksHold_ = false;
  }
  const Bounds bounds = shadowBoundsOf(frame);
  masksHold_ = masksHold_ && bounds == maskBounds_;
  if (frame.groundDrawn && !masksHold_) {
    drawMasks(bounds);
    maskBounds_ = bounds;
    masksHold_ = true;
    ++counts.shadowMasks;
  }
  bindTexture(kShadowUnit, GL_TEXTURE_2D, map_.texture);
  glBindSampler(kShadowUnit, compare_);
  bindTexture(kSharpUnit, GL_TEXTURE_2D, sharp_.texture);
  bindTexture(kWideUnit, GL_TEXTURE_2D, wide_.texture);
}

}  // namespace render
