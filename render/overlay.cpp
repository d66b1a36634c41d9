// Labels follow their points; the caption and the panel keep their corners.
#include "render/overlay.h"

#include "render/hud.h"

namespace render {
namespace {

constexpr float kCaptionMargin = 18, kCaptionSize = 18;  // pixels at 720 lines
const Color kCaptionInk(0.13f, 0.14f, 0.16f, 1);

void drawLabel(Canvas& canvas, const Label& label, const Frame& frame, int width, int height,
               float scale) {
  if (frame.depthOf(label.at) < frame.nearest) return;
  const Eigen::Vector4f clip = frame.block.toClip * label.at.homogeneous();
  const Pixel at((0.5f + 0.5f * clip.x() / clip.w()) * static_cast<float>(width),
                 (0.5f - 0.5f * clip.y() / clip.w()) * static_cast<float>(height));
  const float size = scale * label.size;
  Pixel start = at + scale * label.offset;
  if (label.anchor != 0) start.x() -= label.anchor * canvas.widthOfMarked(label.text, size);
  canvas.markedText(start, size, label.color, label.text, true);
}

}  // namespace

bool hasOverlay(const Picture& picture) {
  return !picture.labels.empty() || !picture.caption.empty() || picture.hud.visible;
}

void drawOverlay(Canvas& canvas, const Picture& picture, const Frame& frame, int width,
                 int height) {
  const float scale = static_cast<float>(height) / 720.0f;
  canvas.begin(width, height);
  for (const Label& label : picture.labels) drawLabel(canvas, label, frame, width, height, scale);
  if (!picture.caption.empty())
    canvas.textWithHalo(
        {kCaptionMargin * scale, static_cast<float>(height) - kCaptionMargin * scale},
        kCaptionSize * scale, kCaptionInk, picture.caption);
  if (picture.hud.visible) drawHud(canvas, picture.hud, scale);
  canvas.draw();
}

}  // namespace render
