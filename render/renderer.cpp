// The order of passes: shadow, ground, bodies, the mean of several such pictures where that is
// asked for, overlay, and the way back to memory.
#include "render/renderer.h"

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>

#include "render/bodies.h"
#include "render/bounds.h"
#include "render/canvas.h"
#include "render/context.h"
#include "render/floor.h"
#include "render/frame.h"
#include "render/light_maps.h"
#include "render/mean.h"
#include "render/overlay.h"
#include "render/shaders.h"
#include "render/shadow.h"
#include "render/shipped.h"
#include "render/strokes.h"
#include "render/surfaces.h"

namespace render {

namespace {

const RendererOptions& checked(const RendererOptions& options) {
  if (options.width < 1 || options.height < 1 || options.width > 8192 || options.height > 8192)
    throw std::invalid_argument("renderer: width and height must lie in 1...8192, got " +
                                std::to_string(options.width) + " x " +
                                std::to_string(options.height));
  return options;
}

std::string definesOf(const Detail& detail) {
  return detail.exposures > 0 ? "#define EXPOSED\n" : "";
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const RendererOptions& wanted);
  ~Impl() = default;

  void drawScene(const Picture& picture, const Frame& frame);
  void drawGround(const Frame& frame) const;
  void drawBodies(const Bounds& bounds);
  void drawShadows(const Frame& frame);
  void drawMean(std::span<const Picture> moments, const Frame& frame);
  void drawLetters(const Picture& drawn, const Frame& frame);
  void readBack();
  void putBack() const;  // what was read back, or made of it
  void fillImage(bool opaque);

  Context context;  // first: all that follows lives in it
  RendererOptions options;
  Detail detail;
  Bodies bodies;
  Surfaces surfaces;
  std::optional<Shadow> shadow;  // made for the first picture that asks for it, as the next two
  std::optional<LightMaps> lights;
  Floor floor;
  Strokes strokes;
  std::optional<Canvas> canvas;
  DrawCounts counts;
  GLuint frameBuffer = 0, resolveProgram = 0, emptyArray = 0;
  GLuint bodyTexture = 0, bodyFramebuffer = 0;  // multisampled, or the picture's own
  GLuint pictureTexture = 0, pictureFramebuffer = 0;
  Mean mean;
  std::vector<std::uint8_t> rgba;  // rows from the bottom, colour premultiplied
  Image image;
};

Renderer::Impl::Impl(const RendererOptions& wanted)
    : options(checked(wanted)),
      detail(detailOf(wanted.quality)),
      bodies(definesOf(detail)),
      surfaces(definesOf(detail)),
      floor(definesOf(detail)) {
  if (!wanted.fontFile.empty()) canvas.emplace(wanted.fontFile);
  frameBuffer = makeBuffer();
  resolveProgram = makeProgram(kViewportVertex, kResolveFragment);
  emptyArray = makeVertexArray();
  const int width = options.width, height = options.height;
  pictureTexture = makeTexture(GL_RGBA8, width, height, GL_LINEAR);
  pictureFramebuffer = makeFramebuffer(pictureTexture, "the picture");
  bodyFramebuffer = pictureFramebuffer;
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

void Renderer::Impl::drawGround(const Frame& frame) const {
  const Color& back = frame.block.background;
  glBindFramebuffer(GL_FRAMEBUFFER, pictureFramebuffer);
  glViewport(0, 0, options.width, options.height);
  glClearColor(back.x() * back.w(), back.y() * back.w(), back.z() * back.w(), back.w());
  glClear(GL_COLOR_BUFFER_BIT);
  if (frame.groundDrawn) floor.draw();
}

// Bodies go into a multisampled framebuffer of their own and from there over the ground.
void Renderer::Impl::drawBodies(const Bounds& bounds) {
  if (bounds.empty()) return;
  const bool smooth = detail.samples > 1;
  glBindFramebuffer(GL_FRAMEBUFFER, bodyFramebuffer);
  glClearColor(0, 0, 0, 0);
  glClear(GL_DEPTH_BUFFER_BIT | (smooth ? GL_COLOR_BUFFER_BIT : 0u));  // cut, it is a drawn quad
  cutTo(bounds, options.width, options.height, 1);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CLIP_DISTANCE0);
  surfaces.drawOpaque();
  bodies.draw();
  surfaces.drawTranslucent();
  glDisable(GL_CLIP_DISTANCE0);
  strokes.drawHidden();
  glDisable(GL_DEPTH_TEST);
  if (smooth) {
    glBindFramebuffer(GL_FRAMEBUFFER, pictureFramebuffer);
    glUseProgram(resolveProgram);
    glBindVertexArray(emptyArray);
    bindTexture(kSourceUnit, GL_TEXTURE_2D_MULTISAMPLE, bodyTexture);
    glEnable(GL_BLEND);
    drawWholeViewport();
    glDisable(GL_BLEND);
  }
  uncut();
}

void Renderer::Impl::drawShadows(const Frame& frame) {
  if (detail.exposures > 0) {
    if (!lights) lights.emplace(detail.shadowSize);
    lights->draw(bodies, surfaces, frame, frameBuffer, counts);
  } else {
    if (!shadow) shadow.emplace(detail.shadowSize);
    shadow->draw(bodies, surfaces, frame, counts);
  }
}

// All but letters, into the picture's framebuffer.
void Renderer::Impl::drawScene(const Picture& picture, const Frame& frame) {
  fillUniforms(frameBuffer, frame.block);
  bodies.arrange(picture, frame);
  surfaces.arrange(picture, frame);
  strokes.arrange(picture, frame);
  if (picture.light.shadows) drawShadows(frame);
  drawGround(frame);
  drawBodies(screenBoundsOf(picture, frame));
  glBindFramebuffer(GL_FRAMEBUFFER, pictureFramebuffer);
  strokes.drawOnTop();
}

// As many pictures as quality and moments ask for, each moment equally often. Which moment goes
// with which point of the light jumps about, or a shadow's edge would tell the time.
void Renderer::Impl::drawMean(std::span<const Picture> moments, const Frame& first) {
  const auto count = static_cast<int>(moments.size());
  const int rounds = std::max(1, (detail.exposures + count - 1) / count);
  const std::vector<Exposure> exposures = spreadExposures(rounds * count);
  mean.begin(first.block.background.w() >= 1);
  for (int i = 0; i < rounds * count; ++i) {
    const int shuffled = static_cast<int>(static_cast<std::int64_t>(i) * 7919 % (rounds * count));
    const Picture& picture = moments[static_cast<std::size_t>(shuffled / rounds)];
    const Frame frame = frameOf(picture, options, detail);
    drawScene(picture, detail.exposures == 0 ? frame
                                             : exposed(frame, picture, detail,
                                                       exposures[static_cast<std::size_t>(i)]));
    readBack();
    mean.add(rgba);
  }
  mean.take(rgba);
}

void Renderer::Impl::drawLetters(const Picture& drawn, const Frame& frame) {
  if (!canvas) canvas.emplace(shippedFont());
  glBindFramebuffer(GL_FRAMEBUFFER, pictureFramebuffer);
  glViewport(0, 0, options.width, options.height);
  drawOverlay(*canvas, drawn, frame, options.width, options.height);
  ++counts.overlays;
}

void Renderer::Impl::readBack() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, pictureFramebuffer);
  glReadPixels(0, 0, options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

void Renderer::Impl::putBack() const {
  bindTexture(kSourceUnit, GL_TEXTURE_2D, pictureTexture);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, options.width, options.height, GL_RGBA, GL_UNSIGNED_BYTE,
                  rgba.data());
}

// Rows from the top; of an opaque picture without alpha.
void Renderer::Impl::fillImage(bool opaque) {
  const auto width = static_cast<std::size_t>(options.width);
  const auto height = static_cast<std::size_t>(options.height);
  image.alpha.resize(opaque ? 0 : width * height);
  std::uint8_t* to = image.rgb.data();
  for (std::size_t row = 0; row < height; ++row) {
    const std::uint8_t* from = rgba.data() + 4 * width * (height - 1 - row);
    for (std::size_t i = 0; i < width; ++i, to += 3, from += 4) {
      const unsigned a = opaque ? 255 : from[3];
      for (int c = 0; c < 3; ++c) {
        to[c] = a == 255 ? from[c]
                         : static_cast<std::uint8_t>(
                               a == 0 ? 0 : std::min(255u, (255u * from[c] + a / 2) / a));
      }
      if (!opaque) image.alpha[row * width + i] = static_cast<std::uint8_t>(a);
    }
  }
}

Renderer::Renderer(const RendererOptions& options) : impl_(std::make_unique<Impl>(options)) {}

Renderer::~Renderer() = default;

const Image& Renderer::draw(const Picture& picture) { return draw(std::span(&picture, 1)); }

const Image& Renderer::draw(std::span<const Picture> moments) {
  if (moments.empty()) throw std::invalid_argument("renderer: no picture");
  Impl& my = *impl_;
  const Picture& picture = moments.front();
  const Frame frame = frameOf(picture, my.options, my.detail);
  const bool once = moments.size() == 1 && my.detail.exposures == 0;
  my.context.makeCurrent();
  if (once) {
    my.drawScene(picture, frame);
  } else {
    my.drawMean(moments, frame);
  }
  if (hasOverlay(picture)) {
    if (!once) my.putBack();
    my.drawLetters(picture, frame);
    my.readBack();
  } else if (once) {
    my.readBack();
  }
  my.fillImage(picture.background.w() >= 1);
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
