// The order of passes: shadow, ground, bodies, overlay, and the way back to memory.
#include "render/renderer.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "render/bodies.h"
#include "render/bounds.h"
#include "render/canvas.h"
#include "render/context.h"
#include "render/floor.h"
#include "render/frame.h"
#include "render/overlay.h"
#include "render/shaders.h"
#include "render/shadow.h"
#include "render/strokes.h"
#include "render/surfaces.h"

namespace render {

// An image without multisampling that passes are collected in.
struct Sheet {
  GLuint framebuffer = 0;
  int width = 0, height = 0;
};

namespace {

Sheet makeSheet(int width, int height) {
  const GLuint texture = makeTexture(GL_RGBA8, width, height, GL_LINEAR);
  return {makeFramebuffer(texture, "the picture"), width, height};
}

const RendererOptions& checked(const RendererOptions& options) {
  if (options.width < 1 || options.height < 1 || options.width > 8192 || options.height > 8192)
    throw std::invalid_argument("renderer: width and height must lie in 1...8192, got " +
                                std::to_string(options.width) + " x " +
                                std::to_string(options.height));
  return options;
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const RendererOptions& wanted);
  ~Impl() = default;

  void upload(const Frame& frame) const;
  void drawGround(const Frame& frame) const;
  void drawBodies(const Bounds& bounds);
  void finishScene() const;
  void drawShadows(const Frame& frame);
  void drawLetters(const Picture& drawn, const Frame& frame);
  void readBack();

  Context context;  // first: all that follows lives in it
  RendererOptions options;
  Detail detail;
  Bodies bodies;
  Surfaces surfaces;
  std::optional<Shadow> shadow;  // made for the first picture that asks for it, as the canvas
  Floor floor;
  Strokes strokes;
  std::optional<Canvas> canvas;
  DrawCounts counts;
  GLuint frameBuffer = 0, resolveProgram = 0, emptyArray = 0;
  GLuint bodyTexture = 0, bodyFramebuffer = 0;  // multisampled, or the scene's own when draft
  Sheet scene, picture;                         // the same unless supersampled
  std::vector<std::uint8_t> rgba;
  Image image;
};

Renderer::Impl::Impl(const RendererOptions& wanted)
    : options(checked(wanted)), detail(detailOf(wanted.quality)) {
  if (!wanted.fontFile.empty()) canvas.emplace(wanted.fontFile);
  frameBuffer = makeBuffer();
  resolveProgram = makeProgram(kViewportVertex, kResolveFragment);
  emptyArray = makeVertexArray();
  const int width = options.width * detail.supersample,
            height = options.height * detail.supersample;
  scene = makeSheet(width, height);
  picture = detail.supersample > 1 ? makeSheet(options.width, options.height) : scene;
  bodyFramebuffer = scene.framebuffer;
  if (detail.samples > 1) {
    glGenFramebuffers(1, &bodyFramebuffer);
    bodyTexture = makeMultisampleTexture(GL_RGBA8, detail.samples, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, bodyFramebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE,
                           bodyTexture, 0);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, bodyFramebuffer);
  const GLuint depth = makeRenderbuffer(GL_DEPTH_COMPONENT24,
                                        detail.samples > 1 ? detail.samples : 0, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  requireCompleteFramebuffer("the bodies");
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  image.width = options.width;
  image.height = options.height;
  image.rgb.resize(3 * static_cast<std::size_t>(options.width) *
                   static_cast<std::size_t>(options.height));
  rgba.resize(image.rgb.size() / 3 * 4);
}

void Renderer::Impl::upload(const Frame& frame) const {
  glBindBuffer(GL_UNIFORM_BUFFER, frameBuffer);
  glBufferData(GL_UNIFORM_BUFFER, sizeof(FrameBlock), &frame.block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frameBuffer);
}

void Renderer::Impl::drawGround(const Frame& frame) const {
  const Color& back = frame.block.background;
  glBindFramebuffer(GL_FRAMEBUFFER, scene.framebuffer);
  glViewport(0, 0, scene.width, scene.height);
  glClearColor(back.x(), back.y(), back.z(), 1);
  glClear(GL_COLOR_BUFFER_BIT);
  if (frame.groundDrawn) floor.draw();
}

// Bodies go into a multisampled framebuffer of their own and from there over the ground.
void Renderer::Impl::drawBodies(const Bounds& bounds) {
  if (bounds.empty()) return;
  const bool smooth = detail.samples > 1;
  cutTo(bounds, scene.width, scene.height, 1);
  glBindFramebuffer(GL_FRAMEBUFFER, bodyFramebuffer);
  glClearColor(0, 0, 0, 0);
  glClear(GL_DEPTH_BUFFER_BIT | (smooth ? GL_COLOR_BUFFER_BIT : 0u));
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CLIP_DISTANCE0);
  surfaces.drawOpaque();
  bodies.draw();
  surfaces.drawTranslucent();
  glDisable(GL_CLIP_DISTANCE0);
  strokes.drawHidden();
  glDisable(GL_DEPTH_TEST);
  if (smooth) {
    glBindFramebuffer(GL_FRAMEBUFFER, scene.framebuffer);
    glUseProgram(resolveProgram);
    glBindVertexArray(emptyArray);
    bindTexture(kSourceUnit, GL_TEXTURE_2D_MULTISAMPLE, bodyTexture);
    glEnable(GL_BLEND);
    drawWholeViewport();
    glDisable(GL_BLEND);
  }
  uncut();
}

void Renderer::Impl::finishScene() const {
  glBindFramebuffer(GL_FRAMEBUFFER, scene.framebuffer);
  strokes.drawOnTop();
  if (detail.supersample > 1) {  // a linear fetch between four pixels is their mean
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, picture.framebuffer);
    glBlitFramebuffer(0, 0, scene.width, scene.height, 0, 0, picture.width, picture.height,
                      GL_COLOR_BUFFER_BIT, GL_LINEAR);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, picture.framebuffer);
  glViewport(0, 0, picture.width, picture.height);
}

void Renderer::Impl::drawShadows(const Frame& frame) {
  if (!shadow) shadow.emplace(detail.shadowSize);
  shadow->draw(bodies, surfaces, frame, counts);
}

void Renderer::Impl::drawLetters(const Picture& drawn, const Frame& frame) {
  if (!canvas) canvas.emplace(shippedFont());
  drawOverlay(*canvas, drawn, frame, picture.width, picture.height);
  ++counts.overlays;
}

// Rows from the top, without alpha.
void Renderer::Impl::readBack() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer);
  glReadPixels(0, 0, options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  const auto width = static_cast<std::size_t>(options.width);
  const auto height = static_cast<std::size_t>(options.height);
  std::uint8_t* to = image.rgb.data();
  for (std::size_t row = 0; row < height; ++row) {
    const std::uint8_t* from = rgba.data() + 4 * width * (height - 1 - row);
    for (std::size_t i = 0; i < width; ++i, to += 3, from += 4) {
      to[0] = from[0];
      to[1] = from[1];
      to[2] = from[2];
    }
  }
}

Renderer::Renderer(const RendererOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Renderer::~Renderer() = default;

const Image& Renderer::draw(const Picture& picture) {
  Impl& my = *impl_;
  const Frame frame = frameOf(picture, my.options, my.detail);
  my.context.makeCurrent();
  my.upload(frame);
  my.bodies.arrange(picture, frame);
  my.surfaces.arrange(picture, frame);
  my.strokes.arrange(picture, frame);
  if (picture.light.shadows) my.drawShadows(frame);
  my.drawGround(frame);
  my.drawBodies(screenBoundsOf(picture, frame));
  my.finishScene();
  if (hasOverlay(picture)) my.drawLetters(picture, frame);
  my.readBack();
  ++my.counts.pictures;
  my.counts.strokes += picture.lines.empty() && picture.dots.empty() ? 0 : 1;
  return my.image;
}

const DrawCounts& Renderer::counts() const { return impl_->counts; }

Renderer::Info Renderer::info() const {
  impl_->context.makeCurrent();
  const auto text = [](GLenum name) {
    return std::string(reinterpret_cast<const char*>(glGetString(name)));
  };
  return {text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION)};
}

}  // namespace render
