// The trajectory and metrics tables.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/simulation.h"

namespace app {

struct StageSeconds {  // spent on one frame
  double simulate = 0, view = 0, draw = 0, write = 0;
};
void archive(physics::Archive& a, StageSeconds& seconds);

// A field, in quotes where it needs them.
std::string csvText(const std::string& text);

std::string trajectoryHeader();
// One row per body of a frame, the world itself left out. Numbers carry 17 digits. `of`: what the
// scene and its bodies are called.
std::string trajectoryRows(const scenes::Simulation& of, int frame,
                           std::span<const physics::Pose> poses,
                           std::span<const physics::Velocity> velocities);

// A row per frame. A constraint kind that is absent in a frame has the error 0 there.
std::string metricsTable(const std::vector<scenes::FrameMetrics>& metrics,
                         const std::vector<StageSeconds>& seconds);

}  // namespace app
