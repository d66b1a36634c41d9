// A figure is one picture of a drawing process, and so is every frame of its film.
#include "app/figure/figure_draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "app/base/build_info.h"
#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/base/shell.h"
#include "app/figure/vector_page.h"
#include "app/run/draw_apart.h"
#include "app/run/frame_folder.h"
#include "app/run/open_renderer.h"
#include "app/run/run_record.h"
#include "render/film.h"
#include "render/page.h"
#include "render/png.h"
#include "scenes/figure/figure_data.h"

namespace app {

namespace {

using scenes::FigureTile;
using scenes::Rectangle;

render::RendererOptions rendererOptions(const Rectangle& cell, render::Quality quality) {
  return {cell.width, cell.height, quality, ""};
}

// Every picture tile in its cell's size; neighbours of one size share a renderer.
std::vector<render::Image> drawTiles(const FigurePlan& plan, const FigureShots& shots,
                                     render::Quality quality) {
  const std::vector<FigureTile>& tiles = plan.sheet.tiles;
  std::vector<render::Image> images(tiles.size());
  std::unique_ptr<render::Renderer> renderer;
  Rectangle drawn;
  for (std::size_t t = 0; t < tiles.size() && !interrupted(); ++t) {
    if (tiles[t].isPlot) continue;
    const Rectangle& cell = plan.page.cells[t];
    if (!renderer || cell.width != drawn.width || cell.height != drawn.height) {
      renderer = openRenderer(rendererOptions(cell, quality));
      drawn = cell;
    }
    images[t] = drawFrame(*renderer, static_cast<int>(t), {&shots.tiles[t], 1});
  }
  return images;
}

// A sheet's own width is meant for 2050 pixels over the 174 mm of a page's two columns.
double widthInPrint(const scenes::FigureSheet& sheet) { return sheet.width * 174.0 / 2050; }

// How it is made again: of a sheet that is shipped by its name, of another by its file.
render::PngNotes notesOf(const FigurePlan& plan, const FigureDrawing& drawing) {
  const scenes::FigureSheet& sheet = plan.sheet;
  const std::vector<std::string> shipped = scenes::figureSheets();
  const bool isShipped = std::find(shipped.begin(), shipped.end(), sheet.path) != shipped.end();
  const std::string source =
      isShipped ? sheet.name : std::filesystem::path(sheet.path).filename().string();
  render::PngNotes notes;
  notes.texts = {
      {"Title", sheet.title},
      {"Software", "dbd " + version()},
      {"Figure", source + " " + hashText(sheet.text)},
      {"Command", fmt::format("dbd figures {} --width {} --quality {}", shellQuoted(source),
                              plan.page.width, qualityName(drawing.quality))}};
  notes.printedWidth = widthInPrint(sheet) / 1000;
  return notes;
}

void addStamp(const std::string& words, const scenes::FigureLayout& layout, const Rectangle& cell,
              render::Page& page) {
  if (words.empty()) return;
  const float size = layout.textSize;
  page.texts.push_back(
      {{static_cast<float>(cell.x) + 0.4f * size, static_cast<float>(cell.y) + 1.05f * size},
       words,
       size,
       0,
       {0.1f, 0.1f, 0.11f, 1},
       true});
}

std::string stampOfTile(const scenes::FigureSheet& sheet, const FigureTile& tile, int frame) {
  const scenes::FigurePanel& panel = sheet.panels[static_cast<std::size_t>(tile.index)];
  const scenes::Scene& scene = sheet.runs[static_cast<std::size_t>(panel.run)].scene;
  const bool superimposed = tile.frames.size() > 1;
  return scenes::stampOf(panel, scene, frame, panel.frames.size() > 1 && !superimposed);
}

render::Page blankPage(const scenes::FigureLayout& layout) {
  render::Page page;
  page.width = layout.width;
  page.height = layout.height;
  page.texts = layout.labels;
  return page;
}

render::Page composeFigure(const FigurePlan& plan, const FigureShots& shots,
                           std::vector<render::Image> images) {
  render::Page page = blankPage(plan.page);
  for (std::size_t t = 0; t < plan.sheet.tiles.size(); ++t) {
    const FigureTile& tile = plan.sheet.tiles[t];
    const Rectangle& cell = plan.page.cells[t];
    if (tile.isPlot) {
      const render::Pixel from(static_cast<float>(cell.x), static_cast<float>(cell.y));
      const render::Pixel size(static_cast<float>(cell.width), static_cast<float>(cell.height));
      const scenes::FigurePlot& plot = plan.sheet.plots[static_cast<std::size_t>(tile.index)];
      page.plots.push_back(
          {from, from + size, scenes::chartOf(plot, shots.series), plan.page.textSize});
      continue;
    }
    page.tiles.push_back({cell.x, cell.y, std::move(images[t])});
    addStamp(stampOfTile(plan.sheet, tile, tile.frames.back()), plan.page, cell, page);
  }
  return page;
}

render::Page filmPage(const FigurePlan& plan, int printed, std::vector<render::Image> cells) {
  render::Page page = blankPage(plan.film);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Rectangle& place = plan.film.cells[c];
    page.tiles.push_back({place.x, place.y, std::move(cells[c])});
    const FigureTile& tile = plan.filmTiles[c];
    const scenes::FigurePanel& panel = plan.sheet.panels[static_cast<std::size_t>(tile.index)];
    const scenes::Scene& scene = plan.sheet.runs[static_cast<std::size_t>(panel.run)].scene;
    const int frame = plan.frameInFilm(tile.index, printed);
    addStamp(scenes::stampOf(panel, scene, frame, true), plan.film, place, page);
  }
  return page;
}

// What a drawing process has: a frame's cells on one page, into its file.
class FilmPainter {
 public:
  FilmPainter(const FigurePlan& plan, const FigureShots& shots, const FrameFolder& folder)
      : plan_(plan), shots_(shots), folder_(folder) {}

  void draw(int frame) {
    if (!renderer_) {
      renderer_ =
          openRenderer(rendererOptions(plan_.film.cells.front(), render::Quality::kStandard));
      printer_ = std::make_unique<render::PagePrinter>();
    }
    std::vector<render::Image> cells;
    for (const std::vector<render::Picture>& film : shots_.film) {
      cells.push_back(drawFrame(*renderer_, frame, {&film[static_cast<std::size_t>(frame)], 1}));
    }
    render::writePng(printer_->print(filmPage(plan_, frame, std::move(cells))),
                     folder_.file(frame));
  }

 private:
  const FigurePlan& plan_;
  const FigureShots& shots_;
  const FrameFolder& folder_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::PagePrinter> printer_;
};

bool drawFilm(const FigurePlan& plan, const FigureShots& shots, const FigureDrawing& drawing,
              const FrameFolder& folder) {
  std::vector<int> frames(static_cast<std::size_t>(plan.filmFrames()));
  std::iota(frames.begin(), frames.end(), 0);
  Progress progress(drawing.progress, plan.sheet.name, "filming", plan.filmFrames());
  FilmPainter painter(plan, shots, folder);
  const bool isWhole = drawApart(
      frames, drawing.threads, [&](int frame) { painter.draw(frame); },
      [&] { progress.advance(); });
  if (isWhole) progress.finish();
  return isWhole;
}

void drawPage(const FigurePlan& plan, const FigureShots& shots, const FigureDrawing& drawing,
              const std::filesystem::path& file) {
  std::vector<render::Image> images = drawTiles(plan, shots, drawing.quality);
  if (interrupted()) return;
  render::PagePrinter printer;
  const render::Page page = composeFigure(plan, shots, std::move(images));
  render::writePng(printer.print(page), file, notesOf(plan, drawing));
  for (const std::string& format : drawing.formats) {
    const std::filesystem::path other = std::filesystem::path(file).replace_extension(format);
    writeFile(other, vectorPage(page, printer.inkOf(page), widthInPrint(plan.sheet), format));
  }
}

}  // namespace

bool drawFigure(const FigurePlan& plan, const FigureShots& shots, const FigureDrawing& drawing,
                const std::filesystem::path& file) {
  Progress progress(drawing.progress, plan.sheet.name, "drawing", 1);
  const bool isDrawn =
      drawApart({0}, 1, [&](int) { drawPage(plan, shots, drawing, file); }) && !interrupted();
  if (isDrawn) progress.finish();
  return isDrawn;
}

bool filmFigure(const FigurePlan& plan, const FigureShots& shots, const FigureDrawing& drawing,
                const std::filesystem::path& output, const std::filesystem::path& file) {
  const FrameFolder folder(output);
  folder.clear();
  if (!drawFilm(plan, shots, drawing, folder)) return false;
  render::FilmOptions options;
  options.framesPerSecond = kFilmRate;
  try {
    render::makeFilm(render::frameFiles(folder.path(), 0, plan.filmFrames() - 1, 1), file, options);
  } catch (const render::FilmError& error) {
    if (interrupted()) return false;
    throw EnvironmentError(error.what());
  }
  return true;
}

}  // namespace app
