// [film]: the steps that frames of a film, slow motion and an open shutter take.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/read/settings_reader.h"

namespace scenes {
namespace {

using physics::Field;
using physics::Unit;

// A blur of fewer moments shows its parts where something moves fast.
constexpr int kMoments = 8;
constexpr int kMostFps = 1'000'000;

// Frames of the film in a second of the motion.
int shownPerSecond(const TableReader& reader, const FilmDef& film) {
  const double exact = film.fps / film.speed, whole = std::round(exact);
  const char* const key = reader.has("speed") ? "speed" : "fps";
  if (std::abs(exact - whole) > 1e-6 * whole || whole < 1 || whole > kMostFps) {
    reader.failAt(key, fmt::format("expected fps / speed to be a whole number from 1 to {}, got "
                                   "{} / {:g} = {:g}",
                                   kMostFps, film.fps, film.speed, exact));
  }
  return static_cast<int>(whole);
}

void divideFrames(const TableReader& reader, Scene& scene) {
  FilmDef& film = scene.film;
  const int shown = shownPerSecond(reader, film);
  const double open = film.shutterDegrees / 360;
  film.every = (scene.fps + shown - 1) / shown;
  if (open > 0) {
    film.every = std::max(film.every, static_cast<int>(std::ceil(kMoments / open - 1e-9)));
    film.moments = static_cast<int>(std::lround(film.every * open));
  }
  const double steps = static_cast<double>(shown) * film.every;
  if (steps > kMostFps) {
    reader.failHere(fmt::format("expected at most {} steps a second, got {:.0f}", kMostFps, steps));
  }
  scene.fps = static_cast<int>(steps);
}

}  // namespace

void readFilm(TableReader& root, Scene& scene) {
  readTable(root, "film", [&](TableReader& reader) {
    FilmDef& film = scene.film;
    film.fps = scene.fps;
    reader(Field{"fps", Unit::kNone, false, 1, 1000}, film.fps);
    reader(Field{"speed", Unit::kNone, false, 1e-6, 1e6}, film.speed);
    reader(Field{"shutter", Unit::kNone, false, 0, 360}, film.shutterDegrees);
    divideFrames(reader, scene);
  });
}

}  // namespace scenes
