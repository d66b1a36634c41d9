// Where the cells of a figure stand on its page, and the words below them. Plain arithmetic.
#pragma once

#include "render/page.h"
#include "scenes/figure/figure_sheet.h"

namespace scenes {

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

struct FigureLayout {
  int width = 0, height = 0;
  float textSize = 34;                     // height of a line; 7 pt at 300 dpi
  std::vector<Rectangle> cells;            // per tile of the sheet
  std::vector<render::Page::Text> labels;  // "(a) pairwise", below the cells of a panel
};

// `width` px wide. `tiles`: the sheet's, or those of its film. `textSize` 0: what is right in
// print, shrunk with the page against the sheet's own width.
FigureLayout layOut(const FigureSheet& sheet, const std::vector<FigureTile>& tiles, int columns,
                    int width, float textSize = 0);

// Cuts into lines that are at most about `width` px wide; a word that is longer stays whole.
std::vector<std::string> wrap(const std::string& words, float size, int width);

// "t = 0.25 s", "3 iterations", or nothing: what a picture of that frame is stamped with.
std::string stampOf(const FigurePanel& panel, const Scene& scene, int frame, bool several);

}  // namespace scenes
