// What is drawn over the bodies on request: contacts, impulses, joints, centres of mass, and the
// HUD.
#pragma once

#include "render/picture.h"
#include "scenes/simulation.h"
#include "scenes/view/view.h"

namespace scenes {

// `scale`: size of the scene [m], which lengths of arrows are fractions of.
void drawOverlays(const Simulation& simulation, const ViewOptions& options, double scale,
                  render::Picture& picture);

// A bar of the whole run that ends where it is no longer trusted [s].
void addTrust(const Simulation& simulation, double until, render::Hud& hud);

render::Hud makeHud(const Simulation& simulation, const std::vector<FrameMetrics>& history);

}  // namespace scenes
