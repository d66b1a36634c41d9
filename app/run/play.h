// Steps a scene from frame to frame, and stops where a user or the numbers ask for it.
#pragma once

#include <functional>
#include <string>

#include "app/commands/exit_code.h"
#include "scenes/simulation.h"

namespace app {

struct PlayEnd {
  ExitCode code = ExitCode::kDone;  // or kInterrupted, or kCheckFailed: not finite
  std::string problem;              // scene, frame, body and constraint, where the numbers failed
  int frames = 0;                   // how many were shown
};

// Shows frames 0..frames-1 to `visit`, with the seconds spent in stepping to each.
PlayEnd play(scenes::Simulation& simulation, int frames,
             const std::function<void(double stepSeconds)>& visit);

}  // namespace app
