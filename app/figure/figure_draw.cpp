// Cells are drawn in parallel; pages are put together on the calling thread.
#include "app/figure/figure_draw.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/base/build_info.h"
#include "app/base/interrupt.h"
#include "app/base/output_file.h"
#include "app/base/shell.h"
#include "app/figure/vector_page.h"
#include "app/run/frame_folder.h"
#include "app/run/pipeline.h"
#include "app/run/run_record.h"
#include "app/run/whole_frames.h"
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

// Every picture tile in its cell's size; cells of one size share their renderers.
bool drawTiles(const FigurePlan& plan, const FigureShots& shots, const FigureDrawing& drawing,
               std::vector<render::Image>& images) {
  const std::vector<FigureTile>& tiles = plan.sheet.tiles;
  std::map<std::pair<int, int>, std::vector<std::size_t>> bySize;
  int total = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    if (tiles[t].isPlot) continue;
    bySize[{plan.page.cells[t].width, plan.page.cells[t].height}].push_back(t);
    ++total;
  }
  images.resize(tiles.size());
  Progress progress(drawing.progress, plan.sheet.name, "drawing", total);
  for (const auto& [size, members] : bySize) {
    const int workers = std::min(drawing.threads, static_cast<int>(members.size()));
    Pipeline pipeline(rendererOptions(plan.page.cells[members.front()], drawing.quality), workers,
                      [&](int tile, const render::Image& image) {
                        images[static_cast<std::size_t>(tile)] = image;
                        progress.advance();
                      });
    for (const std::size_t t : members) {
      if (interrupted()) return false;
      pipeline.draw(static_cast<int>(t), shots.tiles[t]);
    }
    pipeline.finish();
  }
  progress.finish();
  return !interrupted();
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

bool drawFilm(const FigurePlan& plan, FigureShots& shots, const FigureDrawing& drawing,
              const FrameFolder& folder) {
  const int frames = plan.filmFrames(), cells = static_cast<int>(plan.filmTiles.size());
  Progress progress(drawing.progress, plan.sheet.name, "filming", frames);
  WholeFrames film(std::vector<bool>(plan.filmTiles.size(), true));
  render::PagePrinter printer;
  int printed = 0;
  const auto print = [&] {
    while (auto images = film.next()) {
      const render::Page page = filmPage(plan, printed, std::move(*images));
      render::writePng(printer.print(page), folder.file(printed++));
      progress.advance();
    }
  };
  Pipeline pipeline(rendererOptions(plan.film.cells.front(), render::Quality::kStandard),
                    drawing.threads,
                    [&](int job, const render::Image& image) { film.take(job, image); });
  for (int frame = 0; frame < frames; ++frame) {
    if (interrupted()) return false;
    for (int cell = 0; cell < cells; ++cell) {
      auto& pictures = shots.film[static_cast<std::size_t>(cell)];
      pipeline.draw(film.job(frame, cell), std::move(pictures[static_cast<std::size_t>(frame)]));
    }
    print();
  }
  pipeline.finish();
  print();
  progress.finish();
  return true;
}

}  // namespace

bool drawFigure(const FigurePlan& plan, const FigureShots& shots, const FigureDrawing& drawing,
                const std::filesystem::path& file) {
  std::vector<render::Image> images;
  if (!drawTiles(plan, shots, drawing, images)) return false;
  render::PagePrinter printer;
  const render::Page page = composeFigure(plan, shots, std::move(images));
  render::writePng(printer.print(page), file, notesOf(plan, drawing));
  for (const std::string& format : drawing.formats) {
    const std::filesystem::path other = std::filesystem::path(file).replace_extension(format);
    writeFile(other, vectorPage(page, printer.inkOf(page), widthInPrint(plan.sheet), format));
  }
  return true;
}

bool filmFigure(const FigurePlan& plan, FigureShots& shots, const FigureDrawing& drawing,
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
