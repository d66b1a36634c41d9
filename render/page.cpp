// Tiles are copied as they are; plots and text are drawn over them with a Canvas.
#include "render/page.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "render/context.h"
#include "render/gl.h"
#include "render/shipped.h"

namespace render {
namespace {

std::uint8_t byteOf(float share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0f, 1.0f)));
}

Image blank(const Page& page) {
  Image sheet{page.width, page.height, {}};
  const auto pixels = static_cast<std::size_t>(page.width) * static_cast<std::size_t>(page.height);
  sheet.rgb.reserve(3 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (int k = 0; k < 3; ++k) sheet.rgb.push_back(byteOf(page.background[k]));
  }
  return sheet;
}

void put(const Page::Tile& tile, Image& sheet) {
  const int left = std::max(0, tile.x), right = std::min(sheet.width, tile.x + tile.image.width);
  if (left >= right) return;
  for (int row = 0; row < tile.image.height; ++row) {
    const int y = tile.y + row;
    if (y < 0 || y >= sheet.height) continue;
    const auto offset = [](int width, int at, int line) {
      return 3 * (static_cast<std::size_t>(line) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(at));
    };
    std::memcpy(sheet.rgb.data() + offset(sheet.width, left, y),
                tile.image.rgb.data() + offset(tile.image.width, left - tile.x, row),
                3 * static_cast<std::size_t>(right - left));
  }
}

// Between an Image, rows from the top, and the framebuffer, rows from the bottom.
std::vector<std::uint8_t> flipped(const Image& image) {
  std::vector<std::uint8_t> rows(image.rgb.size());
  const std::size_t length = 3 * static_cast<std::size_t>(image.width);
  for (std::size_t row = 0; row < static_cast<std::size_t>(image.height); ++row) {
    const std::size_t other = static_cast<std::size_t>(image.height) - 1 - row;
    std::memcpy(rows.data() + length * row, image.rgb.data() + length * other, length);
  }
  return rows;
}

// Frames of plots that stand under each other begin under each other.
float leftOf(const Page::Plot& plot, const Page& page, Canvas& canvas) {
  float left = 0;
  for (const Page::Plot& other : page.plots) {
    if (other.from.x() != plot.from.x()) continue;
    left = std::max(left, leftOfFrame(canvas, other.chart, other.textSize));
  }
  return left;
}

void drawOver(const Page& page, Canvas& canvas) {
  canvas.begin(page.width, page.height);
  for (const Page::Plot& plot : page.plots) {
    drawChart(canvas, plot.chart, plot.from, plot.to, plot.textSize, leftOf(plot, page, canvas));
  }
  for (const Page::Text& text : page.texts) {
    const float width = canvas.widthOfMarked(text.words, text.size);
    const Pixel start(text.at.x() - text.anchor * width, text.at.y());
    canvas.markedText(start.array().round(), text.size, text.color, text.words, text.halo);
  }
  canvas.draw();
}

}  // namespace

struct PagePrinter::Impl {
  explicit Impl(const std::string& fontFile) : canvas(fontFile) {
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  }
  void resize(int newWidth, int newHeight);

  Context context;  // first: all that follows lives in it
  Canvas canvas;
  GLuint texture = 0, framebuffer = 0;
  int width = 0, height = 0;
};

void PagePrinter::Impl::resize(int newWidth, int newHeight) {
  if (width == newWidth && height == newHeight) return;
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteTextures(1, &texture);
  width = newWidth;
  height = newHeight;
  texture = makeTexture(GL_RGBA8, width, height, GL_NEAREST);
  framebuffer = makeFramebuffer(texture, "the page");
}

PagePrinter::PagePrinter(const std::string& fontFile)
    : impl_(std::make_unique<Impl>(fontFile.empty() ? shippedFont() : fontFile)) {}

PagePrinter::~PagePrinter() = default;

Image PagePrinter::print(const Page& page) {
  constexpr int kMost = 16384;
  if (page.width < 1 || page.height < 1 || page.width > kMost || page.height > kMost) {
    throw std::invalid_argument("page: width and height must lie in 1...16384, got " +
                                std::to_string(page.width) + " x " + std::to_string(page.height));
  }
  Image sheet = blank(page);
  for (const Page::Tile& tile : page.tiles) put(tile, sheet);
  if (page.plots.empty() && page.texts.empty()) return sheet;
  impl_->context.makeCurrent();
  impl_->resize(page.width, page.height);
  const std::vector<std::uint8_t> below = flipped(sheet);
  bindTexture(kSourceUnit, GL_TEXTURE_2D, impl_->texture);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, page.width, page.height, GL_RGB, GL_UNSIGNED_BYTE,
                  below.data());
  glBindFramebuffer(GL_FRAMEBUFFER, impl_->framebuffer);
  glViewport(0, 0, page.width, page.height);
  drawOver(page, impl_->canvas);
  Image above{page.width, page.height, std::vector<std::uint8_t>(sheet.rgb.size())};
  glReadPixels(0, 0, page.width, page.height, GL_RGB, GL_UNSIGNED_BYTE, above.rgb.data());
  sheet.rgb = flipped(above);
  return sheet;
}

std::vector<Ink> PagePrinter::inkOf(const Page& page) {
  impl_->context.makeCurrent();
  std::vector<Ink> ink;
  impl_->canvas.record(&ink);
  drawOver(page, impl_->canvas);
  impl_->canvas.record(nullptr);
  return ink;
}

}  // namespace render
