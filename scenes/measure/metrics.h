// The metrics that [[expect]] may name.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/simulation.h"

namespace scenes {

// What a metric is computed from: one frame, compared with the first one.
struct Sample {
  const Simulation& simulation;
  const FrameMetrics& now;
  const FrameMetrics& start;
  const FrameMetrics& before;                    // the frame before; at the first one itself
  const std::vector<physics::Pose>& startPoses;  // by BodyId
  double largestKinetic;                         // over the frames so far [J]
  std::vector<physics::BodyId> bodies;           // those that the expectation's `body` matches
};

inline const physics::Pose& poseOf(const Sample& s, physics::BodyId b) {
  return s.simulation.world().bodies().pose[b];
}
inline physics::Vec3 moved(const Sample& s, physics::BodyId b) {  // since the start [m]
  return poseOf(s, b).x - s.startPoses[b].x;
}

struct Metric {
  const char* name;
  const char* unit;
  const char* meaning;
  enum class About {
    kScene,
    kEachBody,
    kGroup
  } about;  // one number of the scene, of a body, of several
  double (*scene)(const Sample&);
  double (*body)(const Sample&, physics::BodyId);
  bool isEnergyChange = false;  // a gain above zero, a loss below: both ends are told
};
std::span<const Metric> metrics();      // all of them
std::span<const Metric> bodyMetrics();  // those of a body or of several
std::vector<std::string> metricNames();

// The metric of that name; null: none.
const Metric* findMetric(const std::string& name);

// "stack.*" matches "stack.0"; a name without a star matches itself.
bool matches(const std::string& pattern, const std::string& name);

}  // namespace scenes
