#pragma once

#include "scenes/view/view.h"
#include "tests/scenes/scene_text.h"

namespace scenes {

// How the scene looks at its start, from where all of it is seen.
inline render::Picture pictureOf(const std::string& text, const ViewOptions& options = {}) {
  const Simulation simulation(sceneOf(text));
  MotionBounds bounds;
  bounds.include(simulation);
  return view(simulation, bounds, options, {simulation.metrics()});
}

}  // namespace scenes
