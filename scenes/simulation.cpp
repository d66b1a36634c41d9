// A scene being simulated: its steps build the world, its scripts act between frames.
#include "scenes/simulation.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"
#include "scenes/archive.h"
#include "scenes/moment.h"
#include "scenes/read/recipe.h"

namespace scenes {
namespace {

// 0..1 with zero slope at both ends, so that a drive is not jerked at a key.
double smooth(double t) { return t * t * (3 - 2 * t); }

// The keys before and after a time, and how much of the way between them is done; the same key
// twice outside their span.
template <class Key>
struct Between {
  const Key &a, &b;
  double part;
};

template <class Key>
Between<Key> between(const std::vector<Key>& keys, double time, bool isSmooth = true) {
  const auto after =
      std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.time > time; });
  const auto& b = after == keys.end() ? keys.back() : *after;
  const auto& a = after == keys.begin() ? b : *(after - 1);
  const double part = b.time > a.time ? (time - a.time) / (b.time - a.time) : 1;
  return {a, b, isSmooth ? smooth(part) : part};
}

physics::Quat between(const physics::Quat& a, const physics::Quat& b, double part) {
  return physics::exponential(part * physics::logarithm((b * a.conjugate()).normalized())) * a;
}

// The velocity that takes a bone in a step to where it should be. What repeats goes on from where
// it has come to, on the level.
void lead(const PoseScript& script, const Between<PoseScript::Key>& keys, double repeats,
          physics::World& world) {
  const auto& [a, b, part] = keys;
  physics::Vec3 way = script.keys.back().root.x - script.keys.front().root.x;
  way.y() = 0;
  const physics::Vec3 x = a.root.x + part * (b.root.x - a.root.x) + repeats * way;
  const physics::Quat q = between(a.root.q, b.root.q, part) * script.start.q;
  const physics::Pose& now = world.bodies().pose[script.root];
  const double dt = world.settings().dt;
  world.setVelocity(script.root, {(script.start.x + x - now.x) / dt,
                                  physics::logarithm((q * now.q.conjugate()).normalized()) / dt});
}

void follow(const PoseScript& script, double time, physics::World& world) {
  double repeats = 0;
  if (script.repeat) {
    const double first = script.keys.front().time, period = script.keys.back().time - first;
    repeats = std::max(0.0, std::floor((time - first) / period));
    time -= period * repeats;
  }
  const auto keys = between(script.keys, time, !script.isCaptured);
  for (size_t i = 0; i < script.drives.size(); ++i) {
    world.setDriveTarget(script.drives[i],
                         between(keys.a.targets[i], keys.b.targets[i], keys.part));
  }
  if (script.root >= 0) lead(script, keys, repeats, world);
}

void follow(const ArmScript& script, double time, physics::World& world) {
  if (script.follow >= 0) {
    const physics::Vec3& v = world.bodies().velocity[script.follow].v;
    const physics::Vec3& x = world.bodies().pose[script.follow].x;
    return world.setArmTarget(script.arm, x + world.settings().dt * v);
  }
  const auto [a, b, part] = between(script.keys, time);
  world.setArmTarget(script.arm, a.at + (b.jump && part < 1 ? 0 : part) * (b.at - a.at));
}

// The arm that is furthest from its target, beside the errors of the constraints.
physics::KindError errorOf(const std::vector<physics::ArmReport>& arms) {
  physics::KindError error{physics::ArmDef::kWord, "m"};
  for (const physics::ArmReport& arm : arms) {
    if (error.worst < 0 || arm.error > error.largest) error.worst = error.count;
    error.largest = std::max(error.largest, arm.error);
    error.sum += arm.error;
    ++error.count;
  }
  return error;
}

}  // namespace

struct Simulation::Impl {
  Scene scene;
  Built built;
  int frame = 0;
  int iterations = 0, restarts = 0, fallbacks = 0, asleep = 0;
  physics::AccuracyReport accuracy;
  bool finite = true;
  std::optional<Moment> shown;  // instead of what the world tells

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

void Simulation::setThreads(int count) { impl_->built.world.setThreads(count); }

physics::StepReport Simulation::advance() {
  impl_->shown.reset();
  const double arrival = static_cast<double>(impl_->frame + 1) / impl_->scene.fps;
  for (const PoseScript& script : impl_->built.scripts) follow(script, arrival, impl_->built.world);
  for (const ArmScript& script : impl_->built.armScripts) {
    follow(script, arrival, impl_->built.world);
  }
  physics::StepReport report = impl_->built.world.step();
  impl_->iterations = report.iterations;
  impl_->restarts = report.restarts;
  impl_->fallbacks = report.fallbacks;
  impl_->asleep = report.asleep;
  impl_->accuracy = report.accuracy;
  impl_->finite = !report.notFinite;
  if (impl_->finite) ++impl_->frame;
  return report;
}

bool Simulation::place(std::span<const physics::Pose> poses,
                       std::span<const physics::Velocity> velocities) {
  impl_->iterations = impl_->restarts = impl_->fallbacks = impl_->asleep = 0;
  impl_->accuracy = {};
  impl_->shown.reset();
  impl_->finite = impl_->built.world.setState(poses, velocities);
  if (impl_->finite) ++impl_->frame;
  return impl_->finite;
}

Moment Simulation::moment() const {
  if (impl_->shown) return *impl_->shown;
  const physics::Bodies& bodies = world().bodies();
  return {frame(),        bodies.pose, bodies.velocity, world().contacts(),
          world().arms(), metrics(),   stateHash()};
}

bool Simulation::show(const Moment& moment) {
  const auto count = static_cast<std::size_t>(world().bodyCount());
  if (moment.poses.size() != count || moment.velocities.size() != count) return false;
  if (!impl_->built.world.setState(moment.poses, moment.velocities)) return false;
  impl_->frame = moment.frame;
  impl_->shown = moment;
  return true;
}

void Simulation::archive(physics::Archive& a) {
  Impl& i = *impl_;
  a(i.frame, i.iterations, i.restarts, i.fallbacks, i.asleep, i.accuracy, i.finite);
  std::string world = a.reads() ? std::string() : i.built.world.saved();
  a(world);
  if (a.reads()) i.built.world.restore(world);
}

int Simulation::frame() const { return impl_->frame; }
bool Simulation::isFinite() const { return impl_->finite; }
const Scene& Simulation::scene() const { return impl_->scene; }
const physics::World& Simulation::world() const { return impl_->built.world; }
std::uint64_t Simulation::stateHash() const {
  return impl_->shown ? impl_->shown->stateHash : physics::stateHash(world());
}
std::vector<physics::ContactReport> Simulation::contacts() const {
  return impl_->shown ? impl_->shown->contacts : world().contacts();
}
std::vector<physics::ArmReport> Simulation::arms() const {
  return impl_->shown ? impl_->shown->arms : world().arms();
}
const Simulation::Appearance& Simulation::appearance() const { return impl_->built.appearance; }

FrameMetrics Simulation::metrics() const {
  if (impl_->shown) return impl_->shown->metrics;
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
  const std::vector<physics::ArmReport> arms = world().arms();
  if (!arms.empty()) metrics.errors.push_back(errorOf(arms));
  metrics.overlap = world().largestOverlap();
  for (const physics::Velocity& velocity : world().bodies().velocity) {
    metrics.maxSpeed = std::max(metrics.maxSpeed, velocity.v.norm());
  }
  metrics.contacts = world().contactCount();
  metrics.iterations = impl_->iterations;
  metrics.restarts = impl_->restarts;
  metrics.fallbacks = impl_->fallbacks;
  metrics.asleep = impl_->asleep;
  metrics.accuracy = impl_->accuracy;
  return metrics;
}

const std::string& Simulation::bodyName(physics::BodyId body) const {
  return impl_->built.names.at(static_cast<size_t>(body));
}

bool Simulation::isMeant(const Patterns& patterns, physics::BodyId body) const {
  return matches(patterns, bodyName(body)) ||
         std::any_of(patterns.any.begin(), patterns.any.end(),
                     [&](const std::string& name) { return findBody(name) == body; });
}

physics::BodyId Simulation::findBody(const std::string& name) const {
  const auto found = impl_->built.ids.find(name);
  return found == impl_->built.ids.end() ? -1 : found->second;
}

}  // namespace scenes
