// The motion of a run, frame by frame, as two runs are compared by it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/run/play.h"

namespace app {

using BodyPair = std::pair<physics::BodyId, physics::BodyId>;  // the smaller first

struct TrackFrame {
  double time = 0;                            // s
  std::vector<physics::Pose> poses;           // by BodyId
  std::vector<physics::Velocity> velocities;  // by BodyId
  std::vector<BodyPair> touching;             // sorted; of runs that were simulated here
};

struct Track {
  std::vector<std::string> names;  // of the bodies; the world is the first
  std::vector<TrackFrame> frames;
  bool hasVelocities = true;  // a motion may be kept without: then they are zero
  PlayEnd end;                // of runs that were simulated here

  int frameCount() const { return static_cast<int>(frames.size()); }
};

// Of the present frame.
TrackFrame trackFrame(const scenes::Simulation& simulation);
std::vector<std::string> trackNames(const scenes::Simulation& simulation);

// The whole run; of its frames each `every`-th is kept.
Track follow(
    const scenes::Scene& scene, int every, int threads, const std::function<void()>& visit = [] {});

// What `dbd simulate --trajectory` writes. Throws InputError with the line where it is none.
Track readTrajectory(const std::filesystem::path& file);

// What `dbd simulate --motion` and `dbd render` write, app/run/motion.h. Throws InputError.
Track readMotion(const std::filesystem::path& file);

}  // namespace app
