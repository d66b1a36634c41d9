// Runs a scene at its accuracy and at a tenth of it, and looks for where the two part.
#include "app/trust/trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/base/parallel.h"
#include "scenes/read/settings_reader.h"

namespace app {

namespace {

using physics::BodyId;

constexpr double kFiner = 10, kChosenAccuracy = 1e-2, kLeastAccuracy = 1e-11;

// What the scene has that no accuracy steps all the time; empty: nothing.
std::string notByAccuracy(const scenes::Scene& scene) {
  const physics::Settings& settings = scene.settings;
  if (!settings.takesSmallSteps()) return scenes::solverText(settings);
  const scenes::Simulation start(scene);
  const auto& isSoft = start.world().bodies().isSoft;
  if (std::find(isSoft.begin(), isSoft.end(), true) != isSoft.end())
    return "cloth and soft bodies all the time";
  for (const physics::JointReport& joint : start.world().joints()) {
    for (const char* kind : {physics::LinkDef::kWord, physics::RopeLengthDef::kWord,
                             physics::BendDef::kWord, physics::VolumeDef::kWord}) {
      if (joint.kind == kind) return "ropes and cloth all the time";
    }
  }
  return "";
}

void lookForEvent(Trust& trust) {
  for (BodyId body = 1; body < static_cast<BodyId>(trust.allowed.size()); ++body) {
    const Allowed& allowed = trust.allowed[body];
    for (int f = 0; allowed.moves && f < trust.frames() && trust.apartAt[body] < 0; ++f) {
      const double distance = apart(trust.track.frames[f].poses[body],
                                    trust.finer.frames[f].poses[body], allowed.radius);
      if (distance > allowed.distance) trust.apartAt[body] = f;
    }
  }
  for (int f = 0; f < trust.frames() && trust.beyond < 0; ++f) {
    if (trust.differences[f].beyond > 0) trust.beyond = f;
  }
  if (trust.beyond < 0) return;
  const BodyId body = trust.differences[trust.beyond].body;
  trust.growth = growthOf(trust.track, trust.finer, body, trust.allowed[body], trust.beyond);
  trust.event = findEvent(trust.track, trust.finer, trust.allowed, body, trust.growth);
}

}  // namespace

double Trust::until() const {
  if (differences.empty()) return 0;
  return isWhole() ? differences.back().time : differences[std::max(0, beyond - 1)].time;
}

TrustPlan planTrust(const SceneReader& read, std::vector<std::string> overrides) {
  TrustPlan plan;
  plan.scene = read(overrides);
  plan.chosen = !plan.scene.settings.accuracy.has_value();
  plan.accuracy = plan.scene.settings.accuracy.value_or(kChosenAccuracy);
  if (plan.chosen) {
    overrides.push_back(fmt::format("simulation.accuracy={:g}", plan.accuracy));
    plan.scene = read(overrides);
  }
  if (plan.accuracy < kLeastAccuracy) {
    throw scenes::InputError(
        fmt::format("{}: simulation.accuracy = {:g}: expected at least {:g}, as it is compared "
                    "with a tenth of it",
                    plan.scene.path, plan.accuracy, kLeastAccuracy));
  }
  overrides.push_back(fmt::format("simulation.accuracy={:.17g}", plan.accuracy / kFiner));
  plan.why = notByAccuracy(plan.scene);
  if (!plan.why.empty()) {
    plan.every = static_cast<int>(kFiner);
    overrides.push_back(fmt::format("simulation.fps={}", plan.every * plan.scene.fps));
  }
  plan.finer = read(overrides);
  return plan;
}

Trust measureTrust(const TrustPlan& plan, int threads, ProgressMode mode) {
  Trust trust;
  trust.plan = plan;
  trust.allowed = allowedOf(scenes::Simulation(plan.scene), plan.accuracy);
  trust.apartAt.assign(trust.allowed.size(), -1);
  Progress progress(mode, plan.scene.name, "simulating at two accuracies",
                    plan.scene.frameCount() + plan.finer.frameCount());
  const auto advance = [&] { progress.advance(); };
  const int each = std::max(1, threads / 2);
  runTasks(2, threads, [&](int run) {  // the longer one first
    (run == 0 ? trust.finer : trust.track) = run == 0
                                                 ? follow(plan.finer, plan.every, each, advance)
                                                 : follow(plan.scene, 1, each, advance);
    return true;
  });
  for (const Track* track : {&trust.track, &trust.finer}) {
    if (trust.code == ExitCode::kDone || track->end.code == ExitCode::kInterrupted) {
      trust.code = track->end.code;
      trust.problem = track->end.problem;
    }
  }
  if (trust.code == ExitCode::kInterrupted) return trust;
  progress.finish();
  trust.differences = differencesOf(trust.track, trust.finer, trust.allowed);
  lookForEvent(trust);
  return trust;
}

}  // namespace app
