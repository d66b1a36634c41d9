// The same measures for every engine: overlaps, joint gaps and energy of poses and velocities in a
// World of ours, whoever found them.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/race/race.h"
#include "scenes/measure/sampler.h"

namespace app {

class RaceMeter {
 public:
  explicit RaceMeter(const scenes::Scene& scene);
  RaceSample measure(const scenes::Simulation& simulation);  // every frame, from 0

 private:
  double sizeOf(const physics::JointReport& joint) const;
  void measureContacts(const physics::World& world, RaceSample& out) const;
  void measureJoints(const physics::World& world, RaceSample& out) const;

  scenes::Sampler sampler_;
  std::vector<double> size_;       // of bodies, by BodyId [m]; 0: a point
  std::vector<double> thickness_;  // of bodies, by BodyId [m]; infinite: none
  double leastEnergy_ = 0;         // J, below which nothing moves
  std::vector<physics::Pose> start_;
  // Pairs that overlap at the start, and how deep [m]: that is the scene's, not an engine's.
  std::map<std::pair<physics::BodyId, physics::BodyId>, double> given_;
};

// The scene with what it expects of its bodies only: what should happen. How exactly is what the
// measures tell, so that lengths may be off by `share` of how thick the thinnest of the bodies is.
scenes::Scene withRoughExpectations(const scenes::Simulation& simulation, double share);

// Why the energy of a scene may grow: a drive, a wind; empty: nothing does work but gravity and
// springs.
std::string energyNote(const scenes::Simulation& simulation);

}  // namespace app
