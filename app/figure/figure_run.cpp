// Plays the runs of a figure one after the other.
#include "app/figure/figure_run.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

using scenes::FigurePanel;
using scenes::FigureSheet;
using scenes::FigureTile;

constexpr int kFilmWidth = 1280, kMostFilmHeight = 720, kMostFilmColumns = 3;
constexpr float kFilmText = 21;     // px
constexpr double kLetterSize = 25;  // px at 720 lines that `ink` = 1 stands for

scenes::ViewOptions viewOptions(const FigurePanel& panel, const scenes::Rectangle& cell,
                                double textSize) {
  scenes::ViewOptions options;
  options.overlays = panel.overlays;
  options.aspect = static_cast<double>(cell.width) / cell.height;
  options.camera = panel.camera;
  options.ink = textSize / kLetterSize * 720 / cell.height;
  options.opacity = panel.opacity;
  options.ground = panel.ground;
  return options;
}

void addNotes(const FigurePanel& panel, const scenes::Simulation& simulation, double ink,
              render::Picture& picture) {
  for (const scenes::FigureNote& note : panel.notes) {
    physics::Vec3 at = note.at;
    if (!note.body.empty()) {
      const physics::BodyId body = simulation.findBody(note.body);
      if (body < 0) {
        throw scenes::InputError(simulation.scene().path + ": no body '" + note.body +
                                 "' for the note '" + note.text + "'");
      }
      at += simulation.world().bodies().pose[static_cast<std::size_t>(body)].x;
    }
    render::Label label;
    label.at = at.cast<float>();
    label.text = note.text;
    label.size = static_cast<float>(kLetterSize * ink);
    label.offset = {label.size * static_cast<float>(note.offset[0]),
                    -label.size * static_cast<float>(note.offset[1])};
    picture.labels.push_back(label);
  }
}

// Bodies of another run, seen through.
void addGhost(const render::Picture& ghost, render::Picture& picture) {
  constexpr float kOpacity = 0.4f, kPaleness = 0.25f;
  std::vector<render::Instance> bodies = ghost.instances;
  for (render::Instance& body : bodies) {
    body.color.head<3>() =
        (1 - kPaleness) * body.color.head<3>() + render::Vec3f::Constant(kPaleness);
    body.color.w() *= kOpacity;
  }
  picture.instances.insert(picture.instances.end(), bodies.begin(), bodies.end());
}

// Earlier moments fade; letters and strokes are the last one's.
render::Picture superimpose(std::vector<render::Picture> moments) {
  constexpr float kFaintest = 0.16f, kLastBut = 0.5f;
  render::Picture result = std::move(moments.back());
  moments.pop_back();
  std::vector<render::Instance> faded;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const float share =
        moments.size() > 1 ? static_cast<float>(i) / static_cast<float>(moments.size() - 1) : 1;
    const float alpha = kFaintest + share * (kLastBut - kFaintest);
    for (render::Instance& instance : moments[i].instances) {
      instance.color.w() *= alpha;
      faded.push_back(std::move(instance));
    }
    for (render::Line& line : moments[i].lines) {
      line.color.w() *= alpha;
      result.lines.push_back(line);
    }
  }
  result.instances.insert(result.instances.begin(), faded.begin(), faded.end());
  return result;
}

class RunPlayer {
 public:
  RunPlayer(const FigurePlan& plan, int run, FigureShots& shots)
      : plan_(plan),
        sheet_(plan.sheet),
        run_(run),
        scene_(plan.sheet.runs[static_cast<std::size_t>(run)].scene),
        shots_(shots),
        bounds_(plan.sheet.panels.size()),
        filmBounds_(plan.sheet.panels.size()) {}

  int passes() const { return needsBounds() ? 2 : 1; }

  int frames() const {
    if (!plan_.filmTiles.empty() || !metricsOf(sheet_, run_).empty()) return scene_.frameCount();
    int last = 0;
    for (const FigurePanel& panel : sheet_.panels) {
      if (shows(panel)) last = std::max(last, panel.frames.back());
    }
    return std::min(last + 1, scene_.frameCount());
  }

  PlayEnd play(Progress& progress) {
    if (needsBounds()) {
      scenes::Simulation simulation(scene_);
      const PlayEnd end = app::play(simulation, frames(), [&](double) {
        includeBounds(simulation);
        progress.advance();
      });
      if (end.code != ExitCode::kDone) return end;
    }
    scenes::Simulation simulation(scene_);
    scenes::SeriesRecorder recorder(simulation, metricsOf(sheet_, run_));
    const PlayEnd end = app::play(simulation, frames(), [&](double) {
      recorder.observe(simulation);
      shoot(simulation);
      progress.advance();
    });
    shots_.series[static_cast<std::size_t>(run_)] = recorder.series();
    finishTiles();
    return end;
  }

 private:
  bool shows(const FigurePanel& panel) const { return panel.run == run_ || isGhostOf(panel); }
  bool isGhostOf(const FigurePanel& panel) const { return panel.ghost && *panel.ghost == run_; }

  const scenes::CameraDef& cameraOf(const std::optional<scenes::CameraDef>& own) const {
    return own ? *own : scene_.camera;
  }

  // A camera that fits what moves wants them, and so does a ground that must look the same in all.
  bool needsBounds() const {
    return std::any_of(sheet_.panels.begin(), sheet_.panels.end(), [&](const FigurePanel& panel) {
      const bool moves = panel.frames.size() > 1 || !plan_.filmTiles.empty();
      const bool fits =
          cameraOf(panel.camera).keys.empty() || cameraOf(panel.filmCamera).keys.empty();
      return panel.run == run_ && (fits || (panel.ground && moves));
    });
  }

  // A still is framed by what the stills show, a film by all that moves.
  void includeBounds(const scenes::Simulation& simulation) {
    for (std::size_t i = 0; i < sheet_.panels.size(); ++i) {
      const FigurePanel& panel = sheet_.panels[i];
      if (panel.run != run_) continue;
      const auto& shown = panel.frames;
      const bool still = std::find(shown.begin(), shown.end(), simulation.frame()) != shown.end();
      if (still) bounds_[i].include(simulation, cameraOf(panel.camera));
      filmBounds_[i].include(simulation, cameraOf(panel.filmCamera));
    }
  }

  render::Picture shot(const scenes::Simulation& simulation, int panelIndex, bool isStill,
                       const scenes::Rectangle& cell, double textSize) const {
    const auto index = static_cast<std::size_t>(panelIndex);
    const FigurePanel& panel = sheet_.panels[index];
    scenes::ViewOptions options = viewOptions(panel, cell, textSize);
    if (!isStill) options.camera = panel.filmCamera;
    const std::string stamp =
        scenes::stampOf(panel, scene_, simulation.frame(), panel.frames.size() > 1);
    options.stampLetters = static_cast<int>(stamp.size());
    const auto& bounds = isStill ? bounds_ : filmBounds_;
    render::Picture picture = scenes::view(simulation, bounds[index], options, {});
    addNotes(panel, simulation, options.ink, picture);
    return picture;
  }

  void shoot(const scenes::Simulation& simulation) {
    const int frame = simulation.frame();
    moments_.resize(sheet_.tiles.size());
    for (std::size_t t = 0; t < sheet_.tiles.size(); ++t) {
      const FigureTile& tile = sheet_.tiles[t];
      if (tile.isPlot || !shows(sheet_.panels[static_cast<std::size_t>(tile.index)])) continue;
      if (std::find(tile.frames.begin(), tile.frames.end(), frame) == tile.frames.end()) continue;
      moments_[t].push_back(
          shot(simulation, tile.index, true, plan_.page.cells[t], plan_.page.textSize));
    }
    for (std::size_t t = 0; t < plan_.filmTiles.size(); ++t) shootFilm(simulation, t);
  }

  void shootFilm(const scenes::Simulation& simulation, std::size_t tile) {
    const int panel = plan_.filmTiles[tile].index;
    const FigurePanel& shown = sheet_.panels[static_cast<std::size_t>(panel)];
    if (!shows(shown)) return;
    std::vector<render::Picture>& film = (shown.run == run_ ? shots_.film : shots_.ghosts)[tile];
    while (static_cast<int>(film.size()) < plan_.filmFrames() &&
           plan_.frameInFilm(panel, static_cast<int>(film.size())) == simulation.frame()) {
      film.push_back(shot(simulation, panel, false, plan_.film.cells[tile], plan_.film.textSize));
    }
  }

  void finishTiles() {
    for (std::size_t t = 0; t < moments_.size(); ++t) {
      if (moments_[t].empty()) continue;
      render::Picture whole = superimpose(std::move(moments_[t]));
      const bool ghost = isGhostOf(sheet_.panels[static_cast<std::size_t>(sheet_.tiles[t].index)]);
      (ghost ? shots_.tileGhosts : shots_.tiles)[t] = std::move(whole);
    }
  }

  const FigurePlan& plan_;
  const FigureSheet& sheet_;
  const int run_;
  const scenes::Scene& scene_;
  FigureShots& shots_;
  std::vector<scenes::MotionBounds> bounds_, filmBounds_;  // per panel
  std::vector<std::vector<render::Picture>> moments_;      // per tile
};

void addGhosts(const FigureSheet& sheet, FigureShots& shots) {
  for (std::size_t t = 0; t < shots.tiles.size(); ++t) {
    addGhost(shots.tileGhosts[t], shots.tiles[t]);
  }
  for (std::size_t p = 0; p < shots.film.size(); ++p) {
    if (!sheet.panels[p].ghost) continue;
    for (std::size_t f = 0; f < shots.film[p].size(); ++f) {
      addGhost(shots.ghosts[p][std::min(f, shots.ghosts[p].size() - 1)], shots.film[p][f]);
    }
  }
}

}  // namespace

int FigurePlan::filmFrames() const {
  double longest = 0;
  for (const FigurePanel& panel : sheet.panels) {
    longest = std::max(longest, sheet.runs[static_cast<std::size_t>(panel.run)].scene.duration);
  }
  return static_cast<int>(std::lround(longest * kFilmRate)) + 1;
}

int FigurePlan::frameInFilm(int panel, int frame) const {
  const int run = sheet.panels[static_cast<std::size_t>(panel)].run;
  const scenes::Scene& scene = sheet.runs[static_cast<std::size_t>(run)].scene;
  return std::min(frame * scene.fps / kFilmRate, scene.frameCount() - 1);
}

FigurePlan planFigure(const FigureSheet& sheet, int width) {
  FigurePlan plan{
      sheet,
      scenes::layOut(sheet, sheet.tiles, sheet.columnCount(), width > 0 ? width : sheet.width),
      {},
      {}};
  if (!sheet.video || sheet.panels.empty()) return plan;
  for (std::size_t i = 0; i < sheet.panels.size(); ++i) {
    plan.filmTiles.push_back({false, static_cast<int>(i), {}, 1, sheet.panels[i].aspect, true});
  }
  const int columns = std::min(kMostFilmColumns, static_cast<int>(sheet.panels.size()));
  plan.film = scenes::layOut(sheet, plan.filmTiles, columns, kFilmWidth, kFilmText);
  if (plan.film.height > kMostFilmHeight) {
    const int narrower = kFilmWidth * kMostFilmHeight / plan.film.height;
    plan.film = scenes::layOut(sheet, plan.filmTiles, columns, narrower, kFilmText);
  }
  return plan;
}

FigureShots simulateFigure(const FigurePlan& plan, ProgressMode mode) {
  FigureShots shots;
  shots.series.resize(plan.sheet.runs.size());
  shots.tiles.resize(plan.sheet.tiles.size());
  shots.film.resize(plan.filmTiles.size());
  std::vector<RunPlayer> players;
  int total = 0;
  for (std::size_t run = 0; run < plan.sheet.runs.size(); ++run) {
    players.emplace_back(plan, static_cast<int>(run), shots);
    total += players.back().passes() * players.back().frames();
  }
  shots.tileGhosts.resize(shots.tiles.size());
  shots.ghosts.resize(shots.film.size());
  Progress progress(mode, plan.sheet.name, "simulating", total);
  for (RunPlayer& player : players) {
    const PlayEnd end = player.play(progress);
    shots.interrupted = end.code == ExitCode::kInterrupted;
    shots.problem = end.problem;
    if (end.code != ExitCode::kDone) return shots;
  }
  progress.finish();
  addGhosts(plan.sheet, shots);
  return shots;
}

}  // namespace app
