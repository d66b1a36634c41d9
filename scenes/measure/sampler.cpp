// What stays from frame to frame while metrics are taken.
#include "scenes/measure/sampler.h"

#include <algorithm>

#include "scenes/archive.h"

namespace scenes {

void Sampler::observe(const Simulation& simulation) {
  before_ = std::move(now_);
  now_ = simulation.metrics();
  if (startPoses_.empty()) {
    start_ = before_ = now_;
    startPoses_ = simulation.world().bodies().pose;
  }
  largestKinetic_ = std::max(largestKinetic_, now_.kinetic);
}

Sample Sampler::sample(const Simulation& simulation, std::vector<physics::BodyId> bodies) const {
  return {simulation, now_, start_, before_, startPoses_, largestKinetic_, std::move(bodies)};
}

void Sampler::archive(physics::Archive& a) {
  a(now_, start_, before_, startPoses_, largestKinetic_);
}

std::vector<physics::BodyId> matchingBodies(const Simulation& simulation,
                                            const std::string& pattern) {
  std::vector<physics::BodyId> bodies;
  if (const physics::BodyId exact = simulation.findBody(pattern); exact >= 0) return {exact};
  for (physics::BodyId b = 1; b < simulation.world().bodyCount(); ++b) {
    if (matches(pattern, simulation.bodyName(b))) bodies.push_back(b);
  }
  return bodies;
}

}  // namespace scenes
