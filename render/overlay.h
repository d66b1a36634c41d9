// What is drawn flat over the finished picture: labels at places of the world, caption, panel.
#pragma once

#include "render/canvas.h"
#include "render/frame.h"
#include "render/picture.h"

namespace render {

bool hasOverlay(const Picture& picture);

// Into the framebuffer that is bound, of `width` by `height` pixels.
void drawOverlay(Canvas& canvas, const Picture& picture, const Frame& frame, int width, int height);

}  // namespace render
