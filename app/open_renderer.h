// A Renderer, or an error that blames the machine.
#pragma once

#include <memory>

#include "render/renderer.h"

namespace app {

std::unique_ptr<render::Renderer> openRenderer(const render::RendererOptions& options);

}  // namespace app
