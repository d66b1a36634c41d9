// A Renderer, or an error that blames the machine, and a frame, or an error that blames the scene.
#include "app/run/open_renderer.h"

#include <stdexcept>
#include <string>

#include "app/commands/exit_code.h"

namespace app {

std::unique_ptr<render::Renderer> openRenderer(const render::RendererOptions& options) {
  try {
    return std::make_unique<render::Renderer>(options);
  } catch (const std::runtime_error& error) {
    throw EnvironmentError(error.what());
  }
}

// States that are finite may be too far away for single precision.
const render::Image& drawFrame(render::Renderer& renderer, int frame,
                               std::span<const render::Picture> moments) {
  try {
    return renderer.draw(moments);
  } catch (const std::invalid_argument& error) {
    throw CheckFailed("frame " + std::to_string(frame) + " cannot be drawn: " + error.what());
  }
}

}  // namespace app
