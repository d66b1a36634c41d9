// Other engines on our scenes, for the studies: made from a World as it stands, stepped, and read
// back, so that the code that measures our methods measures theirs.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "physics/world.h"

namespace app {

// One simulation in another engine. One thread, nothing sleeps, double precision.
class Peer {
 public:
  virtual ~Peer() = default;
  // One step of the engine, contacts found anew. Throws std::runtime_error where it gives up.
  virtual void step(double h) = 0;  // s
  // Poses and velocities by BodyId, for Simulation::place or World::setState.
  virtual void read(std::span<physics::Pose> poses,
                    std::span<physics::Velocity> velocities) const = 0;
  // How often the engine complained of its own numbers so far.
  virtual std::int64_t warnings() const { return 0; }
};

// A peer, or why the engine cannot express the world: "Bullet has no distance joint".
struct PeerStart {
  std::unique_ptr<Peer> peer;
  std::string refusal;
};

// One way of stepping of one engine.
struct PeerMethod {
  std::string name;    // a word: "bullet", "bullet_multibody", "ode", "ode_quick", ...
  std::string title;   // for legends: "Bullet, sequential impulses"
  std::string engine;  // of PeerEngine
  std::string note;    // what it does, and how it was set up
  int iterations = 0;  // the engine's default; 0: its solver does not iterate
};

struct PeerEngine {
  std::string name;     // "Bullet"
  std::string version;  // "3.24, double precision"; empty: it was not there when this was built
  std::string package;  // Debian's
};

std::vector<PeerEngine> peerEngines();
std::vector<PeerMethod> peerMethods();  // of the engines that are there

// Nothing of `world` is changed or kept. `iterations` 0: the engine's default; those of a
// solver that does not iterate are left out of account.
// Throws std::invalid_argument for a method that is not there.
PeerStart startPeer(const std::string& method, const physics::World& world, int iterations = 0);

}  // namespace app
