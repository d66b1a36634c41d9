// What holds bodies and has no body of its own, and bodies that are points: rods, tubes, sheets.
#pragma once

#include "render/picture.h"
#include "scenes/simulation.h"

namespace scenes {

// Springs and other joints that are seen as a thin rod from point to point.
bool isRod(const std::string& kind);

// Held at a point beyond its own shape, as the bob of a pendulum.
bool isHeldFromAfar(const physics::Bodies& bodies, const physics::JointReport& joint,
                    physics::BodyId body, const physics::Vec3& point);
bool isHeldByTheWorld(const physics::Bodies& bodies, const physics::JointReport& joint);

void drawRods(const Simulation& simulation, render::Picture& picture);
void drawTubes(const Simulation& simulation, render::Picture& picture);
void drawSurfaces(const Simulation& simulation, render::Picture& picture);

}  // namespace scenes
