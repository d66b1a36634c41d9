// What a drawing process does: a frame of a motion into its file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/run/frame_folder.h"
#include "app/run/motion.h"
#include "app/run/render_run.h"

namespace app {

class Painter {
 public:
  // All of them stay the caller's. `simulation` is only asked to show.
  Painter(scenes::Simulation& simulation, const Motion& motion, const RenderJob& job,
          const FrameFolder& frames, const RunRecord& record)
      : simulation_(simulation), motion_(motion), job_(job), frames_(frames), record_(record) {}

  // `last`: the last frame that the shutter sees, from `frame` on.
  static std::string task(int frame, int last, const scenes::MotionBounds& bounds);
  std::string draw(const std::string& task);  // the seconds that it took, by stage, as JSON

 private:
  render::Picture view(int frame, const scenes::MotionBounds& bounds);  // with the HUD's history
  render::Picture picture(int frame, const scenes::MotionBounds& bounds,
                          const std::vector<scenes::FrameMetrics>& history);

  scenes::Simulation& simulation_;
  const Motion& motion_;
  const RenderJob& job_;
  const FrameFolder& frames_;
  const RunRecord& record_;
  std::unique_ptr<render::Renderer> renderer_;  // opened by the process that draws
  std::vector<scenes::FrameMetrics> history_;   // for the HUD
};

// Asked in a process of its own, so that this one has no graphics context. None: a signal came.
std::optional<render::Renderer::Info> askRendererInfo();

}  // namespace app
