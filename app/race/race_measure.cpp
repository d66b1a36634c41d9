// Overlaps, joint gaps and energy, and what they are held against.
#include "app/race/race_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/constraints/constraint_item.h"
#include "scenes/measure/thickness.h"

namespace app {

namespace {

constexpr const char* kGaps[] = {physics::BallSocketDef::kWord, physics::PointOnLineDef::kWord,
                                 physics::DistanceDef::kWord, physics::LinkDef::kWord};

constexpr double kRounding = 1e-6;  // of its size in a frame: a body that goes so far is at rest

bool isGap(const std::string& kind) {
  return std::any_of(std::begin(kGaps), std::end(kGaps),
                     [&](const char* gap) { return kind == gap; });
}

constexpr const char* kWorkers[] = {physics::DriveDef::kWord,       physics::MotorDef::kWord,
                                    physics::MotorTorqueDef::kWord, physics::ForceDef::kWord,
                                    physics::DragDef::kWord,        physics::PanelDragDef::kWord};

}  // namespace

RaceMeter::RaceMeter(const scenes::Scene& scene) {
  scenes::Simulation start(scene);
  const physics::Bodies& bodies = start.world().bodies();
  start_ = bodies.pose;
  for (physics::BodyId b = 0; b < bodies.size(); ++b) {
    const bool moves = bodies.motion[b] == physics::Motion::kDynamic;
    size_.push_back(moves ? 2 * physics::boundingRadius(bodies.shape[b]) : 0);
    thickness_.push_back(scenes::thicknessOf(bodies.shape[b]));
    const double slow = kRounding * size_.back() * scene.fps;
    if (moves) leastEnergy_ += bodies.mass[b] * slow * slow / 2;
  }
  // A world knows its contacts from its first step on, or once it is put somewhere.
  const std::vector<physics::Velocity> velocities = bodies.velocity;
  start.place(start_, velocities);
  for (const physics::ContactReport& contact : start.world().contacts()) {
    double& depth = given_[std::minmax(contact.a, contact.b)];
    depth = std::max(depth, -contact.gap);
  }
}

// Of points: how far they are apart at the start.
double RaceMeter::sizeOf(const physics::JointReport& joint) const {
  double size = std::numeric_limits<double>::infinity();
  for (const physics::BodyId b : {joint.a, joint.b}) {
    if (size_[b] > 0) size = std::min(size, size_[b]);
  }
  return std::isfinite(size) ? size : (start_[joint.a].x - start_[joint.b].x).norm();
}

RaceSample RaceMeter::measure(const scenes::Simulation& simulation) {
  sampler_.observe(simulation);
  const scenes::Sample sample = sampler_.sample(simulation, {});
  const physics::World& world = simulation.world();
  RaceSample out;
  out.energy = sample.now.total;
  const double scale =
      std::max({std::abs(sample.start.total), sample.largestKinetic, leastEnergy_});
  out.energyChange = scale > 0 ? (sample.now.total - sample.start.total) / scale : 0;
  measureContacts(world, out);
  measureJoints(world, out);
  return out;
}

void RaceMeter::measureContacts(const physics::World& world, RaceSample& out) const {
  for (const physics::ContactReport& contact : world.contacts()) {
    const auto given = given_.find(std::minmax(contact.a, contact.b));
    const double depth = -contact.gap - (given == given_.end() ? 0 : given->second);
    out.overlap = std::max(out.overlap, depth);
    out.overlapShare =
        std::max(out.overlapShare, depth / std::min(thickness_[contact.a], thickness_[contact.b]));
  }
}

void RaceMeter::measureJoints(const physics::World& world, RaceSample& out) const {
  for (const physics::JointReport& joint : world.joints()) {
    if (!isGap(joint.kind)) continue;
    const double gap = std::abs(joint.error), size = sizeOf(joint);
    out.gap = std::max(out.gap, gap);
    if (size > 0) out.gapShare = std::max(out.gapShare, gap / size);
  }
}

scenes::Scene withRoughExpectations(const scenes::Simulation& simulation, double share) {
  scenes::Scene scene = simulation.scene();
  std::erase_if(scene.expectations, [](const auto& e) { return e.body.empty(); });
  for (scenes::Expectation& expectation : scene.expectations) {
    const scenes::Metric* metric = scenes::findMetric(expectation.metric);
    if (metric == nullptr || metric->unit != std::string("m")) continue;
    double thickness = std::numeric_limits<double>::infinity();
    for (const physics::BodyId b : scenes::matchingBodies(simulation, expectation.body)) {
      thickness = std::min(thickness, scenes::thicknessOf(simulation.world().bodies().shape[b]));
    }
    if (!std::isfinite(thickness)) continue;
    if (expectation.atMost) *expectation.atMost += share * thickness;
    if (expectation.atLeast) *expectation.atLeast -= share * thickness;
  }
  return scene;
}

std::string energyNote(const scenes::Simulation& simulation) {
  for (const physics::ConstraintItem& item : simulation.world().constraints()) {
    for (const char* worker : kWorkers) {
      if (item.kind == std::string(worker)) return "a " + std::string(worker) + " does work";
    }
  }
  const physics::Bodies& bodies = simulation.world().bodies();
  for (physics::BodyId b = 1; b < bodies.size(); ++b) {
    const physics::Velocity& velocity = bodies.velocity[b];
    if (bodies.motion[b] != physics::Motion::kKinematic) continue;
    if (!velocity.v.isZero(0) || !velocity.w.isZero(0)) return "a body that is moved does work";
  }
  return "";
}

}  // namespace app
