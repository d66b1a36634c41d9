// Steps a scene from frame to frame, and stops where a user or the numbers ask for it.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "app/commands/exit_code.h"
#include "scenes/simulation.h"

namespace app {

struct PlayEnd {
  ExitCode code = ExitCode::kDone;  // or kInterrupted, or kCheckFailed: not finite
  std::string problem;              // scene, frame, body and constraint, where the numbers failed
  int frames = 0;                   // how many were shown
  std::optional<physics::StepReport::NotFinite> notFinite;
};

// How a frame came about; nothing of frame 0.
struct PlayedStep {
  physics::StepReport report;
  double wall = 0, processor = 0;  // s, spent in stepping
};

// Another engine that makes the frames in place of the simulation's own World.
struct PlayEngine {
  std::function<void()> step;  // to its next frame
  // Its state as the simulation's next frame; what is not finite keeps the frame. Not timed.
  std::function<std::optional<physics::StepReport::NotFinite>()> show;
};

// Shows frames 0..frames-1 to `visit`, until it says false. Null engine: the World steps. The one
// loop over steps of all commands. `shown`: so many were shown before, and the simulation stands at
// the last of them.
PlayEnd play(scenes::Simulation& simulation, int frames,
             const std::function<bool(const PlayedStep&)>& visit,
             const PlayEngine* engine = nullptr, int shown = 0);

// The same, with the seconds spent in stepping to each.
PlayEnd play(scenes::Simulation& simulation, int frames,
             const std::function<void(double stepSeconds)>& visit, int shown = 0);

}  // namespace app
