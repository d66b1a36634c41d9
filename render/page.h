// A printed figure: images, plots and text at their places on one sheet.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/chart.h"
#include "render/image.h"

namespace render {

struct Page {
  struct Tile {
    int x = 0, y = 0;  // upper left corner [px]
    Image image;
  };
  struct Plot {
    Pixel from = Pixel::Zero(), to = Pixel::Zero();
    Chart chart;
    float textSize = 30;
  };
  struct Text {
    Pixel at = Pixel::Zero();  // on the baseline: its start, middle or end as `anchor` is 0, ½, 1
    std::string words;         // with marks, see Canvas::markedText
    float size = 30, anchor = 0;
    Color color{0.1f, 0.1f, 0.11f, 1};
    bool halo = false;
  };

  int width = 0, height = 0;
  Color background{1, 1, 1, 1};
  std::vector<Tile> tiles;
  std::vector<Plot> plots;
  std::vector<Text> texts;
};

// Owns an OSMesa context, as a Renderer does.
class PagePrinter {
 public:
  // Throws std::runtime_error where there is no OpenGL or no font; empty: the shipped font.
  explicit PagePrinter(const std::string& fontFile = "");
  ~PagePrinter();
  PagePrinter(const PagePrinter&) = delete;
  PagePrinter& operator=(const PagePrinter&) = delete;

  // Tiles keep their bytes; what reaches over the page is cut off. Throws std::invalid_argument for
  // a page without area.
  Image print(const Page& page);

  // Plots and text of the page as they are drawn over its tiles.
  std::vector<Ink> inkOf(const Page& page);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
