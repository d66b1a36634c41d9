// What the tests of the renderer share: a small picture and a look at its pixels.
#pragma once

#include "render/renderer.h"

namespace render {

inline Renderer& renderer() {
  static Renderer shared({160, 120, Quality::kStandard, ""});
  return shared;
}

struct Rgb {
  int r, g, b;
  int sum() const { return r + g + b; }
};

inline Rgb at(const Image& image, int x, int y) {
  const std::size_t i = 3 * static_cast<std::size_t>(y * image.width + x);
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

// A camera on the z axis looks at the origin; no ground.
inline Picture bare() {
  Picture picture;
  picture.camera = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40};
  picture.ground.visible = false;
  picture.focusCenter = {0, 0, 0};
  picture.focusRadius = 2;
  return picture;
}

inline Instance box(const Vec3f& size, const Vec3f& position, const Color& color) {
  Instance instance;
  instance.size = size;
  instance.position = position;
  instance.color = color;
  return instance;
}

const Color kRed(0.8f, 0.1f, 0.1f, 1), kBlack(0, 0, 0, 1);

}  // namespace render
