// The pictures of a figure as one printed page, and as a film.
#pragma once

#include <filesystem>

#include "app/figure/figure_run.h"
#include "render/renderer.h"

namespace app {

struct FigureDrawing {
  render::Quality quality = render::Quality::kPaper;
  int threads = 1;
  ProgressMode progress = ProgressMode::kNone;
  std::vector<std::string> formats = {};  // beside the PNG: "pdf", "svg"
};

// Into `file`, and under its name with other endings. False where a user interrupted it; then
// nothing is written.
bool drawFigure(const FigurePlan& plan, const FigureShots& shots, const FigureDrawing& drawing,
                const std::filesystem::path& file);

// FOLDER/00000.png and on, then `file`. Throws EnvironmentError where ffmpeg fails.
bool filmFigure(const FigurePlan& plan, const FigureShots& shots, const FigureDrawing& drawing,
                const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace app
