// A scene being simulated: its steps build the world, its scripts act between frames.
#include "scenes/simulation.h"

#include <algorithm>
#include <cmath>

#include "scenes/recipe.h"

namespace scenes {
namespace {

// 0..1 with zero slope at both ends, so that a drive is not jerked at a key.
double smooth(double t) { return t * t * (3 - 2 * t); }

void follow(const PoseScript& script, double time, physics::World& world) {
  const auto& keys = script.keys;
  const auto after = std::find_if(keys.begin(), keys.end(),
                                  [&](const PoseScript::Key& key) { return key.time > time; });
  const auto& b = after == keys.end() ? keys.back() : *after;
  const auto& a = after == keys.begin() ? b : *(after - 1);
  const double part = b.time > a.time ? smooth((time - a.time) / (b.time - a.time)) : 1;
  for (size_t i = 0; i < script.drives.size(); ++i) {
    world.setDriveTarget(script.drives[i], a.targets[i].slerp(part, b.targets[i]));
  }
}

}  // namespace

struct Simulation::Impl {
  Scene scene;
  Built built;
  int frame = 0;
  int iterations = 0;
  bool finite = true;

  explicit Impl(const Scene& s) : scene(s), built(s.settings) {
    for (const Step& step : scene.content->steps) step(built);
  }
  double time() const { return static_cast<double>(frame) / scene.fps; }
};

Simulation::Simulation(const Scene& scene) {
  try {
    impl_ = std::make_unique<Impl>(scene);
  } catch (const std::invalid_argument& error) {
    throw InputError(scene.path + ": " + error.what());
  }
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

physics::StepReport Simulation::advance() {
  const double arrival = static_cast<double>(impl_->frame + 1) / impl_->scene.fps;
  for (const PoseScript& script : impl_->built.scripts) follow(script, arrival, impl_->built.world);
  physics::StepReport report = impl_->built.world.step();
  impl_->iterations = report.iterations;
  impl_->finite = !report.notFinite;
  if (impl_->finite) ++impl_->frame;
  return report;
}

int Simulation::frame() const { return impl_->frame; }
bool Simulation::isFinite() const { return impl_->finite; }
const Scene& Simulation::scene() const { return impl_->scene; }
const physics::World& Simulation::world() const { return impl_->built.world; }
std::uint64_t Simulation::stateHash() const { return physics::stateHash(world()); }
const Simulation::Appearance& Simulation::appearance() const { return impl_->built.appearance; }

FrameMetrics Simulation::metrics() const {
  const physics::Measures measures = physics::measure(world());
  FrameMetrics metrics;
  metrics.frame = impl_->frame;
  metrics.time = impl_->time();
  metrics.kinetic = measures.kinetic;
  metrics.potential = measures.potential;
  metrics.total = measures.total();
  metrics.linearMomentum = measures.linearMomentum;
  metrics.angularMomentum = measures.angularMomentum;
  metrics.errors = world().constraintErrors();
  metrics.overlap = world().largestOverlap();
  for (const physics::Velocity& velocity : world().bodies().velocity) {
    metrics.maxSpeed = std::max(metrics.maxSpeed, velocity.v.norm());
  }
  metrics.contacts = world().contactCount();
  metrics.iterations = impl_->iterations;
  return metrics;
}

const std::string& Simulation::bodyName(physics::BodyId body) const {
  return impl_->built.names.at(static_cast<size_t>(body));
}

physics::BodyId Simulation::findBody(const std::string& name) const {
  const auto found = impl_->built.ids.find(name);
  return found == impl_->built.ids.end() ? -1 : found->second;
}

}  // namespace scenes
