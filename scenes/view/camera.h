// Where the picture is taken from: a camera that fits a box, or one that follows keys.
#pragma once

#include "render/picture.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

namespace scenes {

// Looks along def.direction at the whole box, with def.margin to spare, from above `groundHeight`.
render::Camera fitCamera(const CameraDef& def, const MotionBounds& box, double aspect,
                         double groundHeight);

// The keys at a time, along a smooth curve through them; needs at least one.
render::Camera keyCamera(const std::vector<CameraKey>& keys, double time);

}  // namespace scenes
