// A Renderer, or an error that blames the machine, and a frame, or an error that blames the scene.
#pragma once

#include <memory>
#include <span>

#include "render/renderer.h"

namespace app {

std::unique_ptr<render::Renderer> openRenderer(const render::RendererOptions& options);

// Throws CheckFailed that names the frame where it is too far away to be drawn. The image is the
// renderer's, until it draws again.
const render::Image& drawFrame(render::Renderer& renderer, int frame,
                               std::span<const render::Picture> moments);

}  // namespace app
