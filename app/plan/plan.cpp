// Joins what a scene's words switch on with what its steps take.
#include "app/plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "app/plan/plan_counts.h"
#include "scenes/read/settings_reader.h"

namespace app {

namespace {

using scenes::Effect;
using scenes::EffectPart;

// An effect whose time is in that of another one.
struct Within {
  const char *effect, *within;
};
constexpr Within kWithin[] = {{"friction", "contact"}, {"speculative_contact", "contact"}};

// What steps turn to, where it is not the effect's own word.
struct Work {
  const char *work, *effect;
};
constexpr Work kWorks[] = {{"schemes", "second_order"}};

std::string effectOf(const std::string& work, bool spins) {
  if (work == "inertia") return spins ? "spinning_inertia" : "gyroscopic_torque";
  for (const Work& known : kWorks) {
    if (work == known.work) return known.effect;
  }
  return work;
}

PlannedEffect* findEffect(Plan& plan, const std::string& name) {
  const auto found =
      std::find_if(plan.effects.begin(), plan.effects.end(),
                   [&](const PlannedEffect& planned) { return planned.effect.name == name; });
  return found == plan.effects.end() ? nullptr : &*found;
}

// What belongs to no effect that is on stays in the rest.
void shareOut(bool spins, Plan& plan) {
  for (PlannedEffect& planned : plan.effects) {
    const Effect& effect = planned.effect;
    for (const Within& known : kWithin) {
      if (effect.name == known.effect) planned.within = known.within;
    }
    if (effect.on && effect.part != EffectPart::kPictures && planned.within.empty()) {
      planned.share = 0;
    }
  }
  plan.rest = 0;
  for (const auto& [work, share] : plan.step.shares) {
    PlannedEffect* planned = findEffect(plan, effectOf(work, spins));
    (planned != nullptr && planned->share ? *planned->share : plan.rest) += share;
  }
}

void countBodies(const physics::Bodies& bodies, Plan& plan) {
  for (physics::BodyId b = 1; b < bodies.size(); ++b) {
    ++plan.bodies;
    if (bodies.motion[b] != physics::Motion::kDynamic) continue;
    ++plan.moving;
    ++(bodies.inverseInertia[b].isZero(0) ? plan.points : plan.turning);
  }
}

std::string howText(const scenes::Scene& scene) {
  const physics::Settings& s = scene.settings;
  if (s.accuracy && s.takesSmallSteps()) {
    return fmt::format("{}, {} fps, accuracy {:g}: steps and orders as each island's error allows",
                       scenes::wordOf(s.method), scene.fps, *s.accuracy);
  }
  if (s.takesSmallSteps()) {
    return fmt::format("{}, {} fps, {}", scenes::wordOf(s.method), scene.fps,
                       scenes::substepsText(s));
  }
  return fmt::format("{}, {}, {} fps, {}, {} iteration{}", scenes::wordOf(s.method),
                     scenes::wordOf(s.stepping), scene.fps, scenes::substepsText(s), s.iterations,
                     s.iterations == 1 ? "" : "s");
}

}  // namespace

Plan makePlan(const scenes::Scene& scene, const StepEffort& effort) {
  Plan plan;
  plan.name = scene.name;
  plan.title = scene.title;
  plan.path = scene.path;
  plan.overrides = scene.overrides;
  plan.settings = makeRecord(scene).settings;
  plan.how = howText(scene);
  for (Effect& effect : scenes::effectsOf(scene)) {
    plan.rows += effect.rows;
    plan.effects.push_back({std::move(effect), 0, {}, ""});
  }
  plan.step = measureSteps(scene, effort);
  countWork(scene, plan);
  countBodies(scenes::Simulation(scene).world().bodies(), plan);
  shareOut(scene.settings.spinInertia, plan);
  return plan;
}

Json planJson(const Plan& plan) {
  Json effects = Json::array();
  for (const PlannedEffect& planned : plan.effects) {
    const Effect& e = planned.effect;
    effects.push_back({{"name", e.name},
                       {"part", scenes::nameOf(e.part)},
                       {"on", e.on},
                       {"left_out", e.leftOut},
                       {"why", e.why},
                       {"count", e.count},
                       {"unit", e.unit},
                       {"rows", e.rows},
                       {"bytes", planned.bytes},
                       {"share", planned.share ? Json(*planned.share) : Json()},
                       {"within", planned.within},
                       {"without", e.without},
                       {"stays", e.stays}});
  }
  const StepMeasure& step = plan.step;
  return {{"version", 1},
          {"scene",
           {{"name", plan.name},
            {"title", plan.title},
            {"path", plan.path},
            {"overrides", plan.overrides}}},
          {"settings", plan.settings},
          {"bodies",
           {{"all", plan.bodies},
            {"moving", plan.moving},
            {"points", plan.points},
            {"turning", plan.turning}}},
          {"step",
           {{"seconds", step.seconds},
            {"spread", step.spread},
            {"steps", step.steps},
            {"repeats", step.repeats},
            {"evaluations", step.evaluations},
            {"sweeps", step.sweeps},
            {"contacts", step.contacts},
            {"pairs_tested", plan.pairsTested},
            {"pairs_kept", plan.pairsKept},
            {"rows", plan.rows},
            {"bytes", plan.bytes},
            {"problem", step.problem}}},
          {"work", plan.work},
          {"effects", effects},
          {"islands", islandsJson(plan)},
          {"rest", {{"share", plan.rest}}}};
}

}  // namespace app
