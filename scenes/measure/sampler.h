// Feeds metrics: keeps the first frame and the largest energy of a simulation, which they are
// measured against.
#pragma once

#include <string>
#include <vector>

#include "scenes/measure/metrics.h"

namespace scenes {

class Sampler {
 public:
  void observe(const Simulation& simulation);  // every frame, from 0

  // Of the frame observed last. `bodies`: those that the metric is about.
  Sample sample(const Simulation& simulation, std::vector<physics::BodyId> bodies) const;
  double time() const { return now_.time; }
  void archive(physics::Archive& a);

 private:
  FrameMetrics now_, start_, before_;
  std::vector<physics::Pose> startPoses_;
  double largestKinetic_ = 0;
};

// The body of that name, or all whose names match the pattern.
std::vector<physics::BodyId> matchingBodies(const Simulation& simulation,
                                            const std::string& pattern);

}  // namespace scenes
