// The geometry of arms drawn over them, as in figure 9 of the paper.
#pragma once

#include "render/picture.h"
#include "scenes/simulation.h"

namespace scenes {

// `picture.camera` must be set: labels stand beside their vectors as the picture shows them.
void drawArms(const Simulation& simulation, const Overlays& overlays, render::Picture& picture);

}  // namespace scenes
