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
  map_ = makeDepthMap(size_, "the shadow map");
  compare_ = makeDepthSampler();
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
  if (work.newLayer && stillMap_.texture == 0) stillMap_ = makeDepthMap(size_, "the shadow map");
  glViewport(0, 0, size_, size_);
  const CasterState state;
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
