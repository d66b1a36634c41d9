// Tracks of runs that are simulated here.
#include "app/trust/track.h"

#include <algorithm>

namespace app {

namespace {

// Pairs of which a point presses or overlaps.
std::vector<BodyPair> touchingPairs(const physics::World& world) {
  std::vector<BodyPair> pairs;
  for (const physics::ContactReport& contact : world.contacts()) {
    if (contact.gap > 0 && contact.impulse.isZero(0)) continue;
    pairs.emplace_back(std::min(contact.a, contact.b), std::max(contact.a, contact.b));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace

TrackFrame trackFrame(const scenes::Simulation& simulation) {
  const physics::World& world = simulation.world();
  return {static_cast<double>(simulation.frame()) / simulation.scene().fps, world.bodies().pose,
          world.bodies().velocity, touchingPairs(world)};
}

std::vector<std::string> trackNames(const scenes::Simulation& simulation) {
  std::vector<std::string> names;
  for (physics::BodyId b = 0; b < simulation.world().bodyCount(); ++b) {
    names.push_back(simulation.bodyName(b));
  }
  return names;
}

Track follow(const scenes::Scene& scene, int every, int threads,
             const std::function<void()>& visit) {
  scenes::Simulation simulation(scene);
  simulation.setThreads(threads);
  Track track;
  track.names = trackNames(simulation);
  track.end = play(simulation, scene.frameCount(), [&](double) {
    if (simulation.frame() % every == 0) track.frames.push_back(trackFrame(simulation));
    visit();
  });
  return track;
}

}  // namespace app
