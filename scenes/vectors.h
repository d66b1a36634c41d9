// The vectors that a derivation draws, from the live state: lever arms r from the centres of mass x
// to the points p, the error δp, axes n with the angle φ between them, and contact normals.
#pragma once

#include "render/picture.h"
#include "scenes/view/view.h"

namespace scenes {

// Letters are left out where there are more than a few joints and contacts. `scale`: size of the
// scene [m]. The picture's camera is set.
void drawVectors(const Simulation& simulation, double scale, const ViewOptions& options,
                 render::Picture& picture);

}  // namespace scenes
