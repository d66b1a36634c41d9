// A Renderer, or an error that blames the machine.
#include "app/open_renderer.h"

#include <stdexcept>

#include "app/exit_code.h"

namespace app {

std::unique_ptr<render::Renderer> openRenderer(const render::RendererOptions& options) {
  try {
    return std::make_unique<render::Renderer>(options);
  } catch (const std::runtime_error& error) {
    throw EnvironmentError(error.what());
  }
}

}  // namespace app
