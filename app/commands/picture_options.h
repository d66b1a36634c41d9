// --size and --quality, as every command that draws frames has them.
#pragma once

#include <string>

#include "render/renderer.h"

namespace CLI {
class App;
}

namespace app {

struct PictureOptions {
  std::string size, quality;  // empty: the defaults

  // The size is that of the quality where none is asked for. Throws InputError.
  render::RendererOptions renderer() const;
};

void addPictureOptions(CLI::App& command, PictureOptions& options);

struct PictureSize {
  int width = 0, height = 0;  // px
};
PictureSize parseSize(const std::string& text);  // "1280x720"; throws InputError that names --size

// Throws EnvironmentError where there is no ffmpeg for what `option` asks for.
void requireFfmpeg(const std::string& option);

}  // namespace app
