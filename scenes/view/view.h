// World + Appearance -> Picture.
#pragma once

#include <optional>
#include <span>

#include "render/picture.h"
#include "scenes/simulation.h"

namespace scenes {

// Bounds of all that moves, over every frame fed to it; what a fitting camera needs.
struct MotionBounds {
  physics::Vec3 low = physics::Vec3::Constant(1e300), high = physics::Vec3::Constant(-1e300);
  void include(const Simulation& simulation);  // the bodies that the scene's camera fits
  void include(const Simulation& simulation, const CameraDef& camera);
  // Where `poses` has them, by BodyId, instead of where they are. Of a camera that follows, they
  // are places against what it follows.
  void include(const Simulation& simulation, const CameraDef& camera,
               std::span<const physics::Pose> poses);
};

// True when the whole motion must be known before the first picture: for a camera that fits it, and
// for a shutter, which sees moments to come.
bool needsMotionBounds(const Scene& scene);

struct ViewOptions {
  bool hud = false;
  std::optional<double> trustedUntil;  // s: the HUD has a bar of the run that ends there
  Overlays overlays;
  double aspect = 16.0 / 9;
  std::optional<CameraDef> camera;  // absent: the scene's
  double ink = 1;                   // how many times larger lines, dots and letters are drawn
  double opacity = 1;               // of the bodies
  bool ground = true;
  int stampLetters = 0;  // of the text at the upper left, which letters keep off
};

// The body of each instance that a picture begins with; rods and tubes come after them.
std::vector<physics::BodyId> drawnBodies(const Simulation& simulation);

// The camera of `def`, which has keys, at the present frame, moved along with what it follows.
render::Camera keyCamera(const Simulation& simulation, const CameraDef& def);

// One for each [[label]] of the scene, where it stands at the present frame; without its text at
// times when it is not shown.
std::vector<render::Label> labels(const Simulation& simulation);

// The picture of the simulation's present frame. `history`: metrics of frames 0..now, for the HUD.
render::Picture view(const Simulation& simulation, const MotionBounds& bounds,
                     const ViewOptions& options, const std::vector<FrameMetrics>& history);

}  // namespace scenes
