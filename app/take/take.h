// A run to take along: what its frames show as plain numbers, for files that others open.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/run/motion.h"
#include "render/picture.h"
#include "scenes/view/view.h"

namespace app {

struct TakePart {         // a body, or a rod or tube that has none of its own
  render::Instance look;  // as in the first frame that it is in
  std::string name;       // of the body; else empty
};

struct TakeSurface {
  render::Surface look;   // as in the first frame
  std::size_t first = 0;  // of its positions among those of all surfaces
};

// Drawn over the bodies, as render::Line and render::Dot are; a dot is a stroke without length.
struct TakeStyle {
  render::Color color{0, 0, 0, 1};
  float width = 2;  // pixels at 720 lines
  bool arrow = false;

  bool operator==(const TakeStyle&) const = default;
};
struct TakeStroke {
  render::Vec3f from = render::Vec3f::Zero(), to = render::Vec3f::Zero();
  std::size_t style = 0;
};
struct TakeLayer {  // what one word of --overlays shows
  std::string name;
  std::vector<TakeStyle> styles;
  std::vector<std::vector<TakeStroke>> frames;
  std::size_t strokes = 0;
};

struct Take {
  static constexpr std::size_t kPart = 8;  // x y z [m], qx qy qz qw, size.y; 0: not in this frame
  // eye, target [m], field of view [degrees], the middle of what is followed [m]
  static constexpr std::size_t kCamera = 10;
  static constexpr std::size_t kLabel = 4;  // x y z [m], 1 where it is shown

  render::Picture stage;     // ground, light, focus and camera of the first frame
  int fps = 60, frames = 0;  // those of the film, of a second and of all of the motion
  std::vector<TakePart> parts;
  std::vector<TakeSurface> surfaces;
  std::vector<render::Label> labels;
  // By frame: rows of kPart numbers a part, of 3 a position of a surface, of kCamera, of kLabel a
  // label.
  std::vector<std::vector<float>> poses, positions, cameras, labelPlaces;
  std::vector<std::string> metricNames;
  std::vector<std::vector<float>> metrics;
  std::vector<TakeLayer> layers;     // none is empty
  std::vector<std::string> missing;  // layers that this has no room for
};

// The words of --overlays that are layers, and their switches.
std::span<const std::pair<const char*, bool scenes::Overlays::*>> takeLayers();

// Throws InputError, with the name of `file`, where the motion of what begins as `start` is more
// than a browser opens.
void requireRoom(const std::string& file, const scenes::Simulation& start, int frames);

// The frames that a film would show. `motion` must fit `simulation`, which is only asked to show.
Take recordTake(scenes::Simulation& simulation, const Motion& motion);

}  // namespace app
