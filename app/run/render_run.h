// Simulating and drawing a scene into a folder of frames, or continuing where a run was stopped.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/base/progress.h"
#include "app/run/play.h"
#include "app/run/run_record.h"
#include "scenes/view/view.h"

namespace app {

struct RenderJob {
  render::RendererOptions renderer;
  scenes::ViewOptions view;
  std::vector<int> frames;                 // ascending
  double printWidth = 0;                   // cm; 0: files do not tell
  std::vector<std::string> askedOverlays;  // on the command line, beside the scene's own
  std::filesystem::path folder;
  int threads = 1;
  std::filesystem::path from;  // a motion to draw; empty: the scene is simulated
  bool keepsMotion = false;    // the motion is wanted after the frames, with its contacts
  bool fresh = false;          // draw all again, whatever the folder holds
  ProgressMode progress = ProgressMode::kNone;
};

struct RenderResult {
  PlayEnd end;
  RunRecord record;
  int drawn = 0, kept = 0;  // frames
};

// What the frames depend on beside the states, and which are asked for.
void notePicture(const RenderJob& job, const render::Renderer::Info& info, RunRecord& record);

// The scene is simulated once, into motion.npz of the folder, and drawn from there. Frames that the
// folder holds already are kept when run.json says that the same program drew them from the same
// scene with the same settings, and so is the motion. Throws InputError, and leaves the folder as
// it is, where it holds frames of another run and `fresh` is not asked for.
//
// Forks: to be called while the program has one thread and no graphics context.
RenderResult renderFrames(const scenes::Scene& scene, const RenderJob& job);

}  // namespace app
