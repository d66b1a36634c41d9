// --size and --quality, as every command that draws frames has them.
#pragma once

#include <string>

#include "render/renderer.h"

namespace CLI {
class App;
}

namespace app {

struct PictureOptions {
  std::string size, quality = "standard";

  // The size is that of the quality where none is asked for. Throws InputError.
  render::RendererOptions renderer() const;
};

void addPictureOptions(CLI::App& command, PictureOptions& options);
void requireFfmpeg();  // throws EnvironmentError where --video finds none

}  // namespace app
