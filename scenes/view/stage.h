// What a picture is about: where its bodies go, what stands around them, what a camera follows.
#pragma once

#include <span>

#include "scenes/simulation.h"
#include "scenes/view/view.h"

namespace scenes {

bool isPlane(const physics::Bodies& bodies, physics::BodyId body);

double radiusOf(const MotionBounds& box);
physics::Vec3 centreOf(const MotionBounds& box);

// The middle of what the camera follows; the origin where it follows nothing.
physics::Vec3 followed(const Simulation& simulation, const CameraDef& camera,
                       std::span<const physics::Pose> poses);

// The motion, the points that hold it, and fixed things of its size that stand around it. Never
// empty.
MotionBounds stageOf(const Simulation& simulation, const MotionBounds& motion,
                     const CameraDef& camera);

}  // namespace scenes
