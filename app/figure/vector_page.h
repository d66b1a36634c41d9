// A figure's page as PDF or SVG: its pictures as images, its plots and words as lines and letters.
#pragma once

#include <string>
#include <vector>

#include "render/ink.h"
#include "render/page.h"

namespace app {

// `millimetres`: how wide it is in print. `format`: "pdf", whose letters are text in a font that is
// inside, or "svg", whose letters are outlines. Returns the file's bytes; throws std::runtime_error
// where the font cannot be read.
std::string vectorPage(const render::Page& page, const std::vector<render::Ink>& ink,
                       double millimetres, const std::string& format);

}  // namespace app
