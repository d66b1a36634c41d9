// Pictures of the stability study: how a run ends, and the frames around the first bad one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/study/stability_run.h"
#include "scenes/view/view.h"

namespace app {

struct StabilityShot {
  std::string file;  // name in the output folder
  std::string caption;
  int frame = 0;
  bool isClose = false;  // only the bodies that failed
};

// Draws the last frame of a run while it is simulated: feed it every frame.
class EndPicture {
 public:
  void observe(const scenes::Simulation& simulation, bool failed);
  // False: the run did not come to its last frame.
  bool write(const std::filesystem::path& file) const;

 private:
  scenes::MotionBounds bounds_;
  std::optional<render::Picture> picture_;
};

// The frames before, at and after the run's failure, as far as they exist, and the bodies where it
// failed.
std::vector<StabilityShot> planFailureShots(const StabilityRun& run);

// Simulates again and draws those whose file is not there. False: interrupted.
bool drawFailureShots(const scenes::StabilityCase& study, const std::vector<std::string>& set,
                      const StabilityRun& run, const std::vector<StabilityShot>& shots,
                      const std::filesystem::path& folder);

}  // namespace app
