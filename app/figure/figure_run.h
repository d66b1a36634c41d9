// Simulating what a figure shows and measures: each run once, all its pictures and numbers on the
// way.
#pragma once

#include "app/base/progress.h"
#include "app/run/play.h"
#include "scenes/figure/figure_layout.h"
#include "scenes/view/view.h"

namespace app {

struct FigurePlan {
  const scenes::FigureSheet& sheet;
  scenes::FigureLayout page;
  std::vector<scenes::FigureTile> filmTiles;  // one per panel; empty: no film
  scenes::FigureLayout film;

  int filmFrames() const;                       // at kFilmRate, as long as the longest scene
  int frameInFilm(int panel, int frame) const;  // which frame of the panel's run it shows
};

constexpr int kFilmRate = 30;  // frames per second

// `width` 0: the sheet's own.
FigurePlan planFigure(const scenes::FigureSheet& sheet, int width);

struct FigureShots {
  std::vector<scenes::Series> series;              // per run
  std::vector<render::Picture> tiles;              // per tile; empty ones for plots
  std::vector<std::vector<render::Picture>> film;  // per panel, per frame of the film
  std::vector<render::Picture> tileGhosts;         // what their panels' ghosts show
  std::vector<std::vector<render::Picture>> ghosts;
  std::string problem;  // where numbers failed
  bool interrupted = false;
};
FigureShots simulateFigure(const FigurePlan& plan, ProgressMode progress);

}  // namespace app
