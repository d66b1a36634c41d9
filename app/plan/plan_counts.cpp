// Counts and bytes of a plan, from the World itself.
#include "app/plan/plan_counts.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace app {

namespace {

template <class Work, class F>
void forEachCount(Work& work, F&& f) {
  f("broad_phase", work.broadPhase);
  f("narrow_phase", work.narrowPhase);
  f("contact_visits", work.contactVisits);
  f("friction_rows", work.frictionRows);
  f("turns", work.turns);
  f("gyroscopic", work.gyroscopic);
  f("moves", work.moves);
  f("rest_speeds", work.restSpeeds);
  f("made_anew", work.madeAnew);
}

void add(const physics::StepWork& work, physics::StepWork& sum) {
  std::vector<std::int64_t> counts;
  forEachCount(work, [&](const char*, const auto& count) { counts.push_back(count); });
  auto next = counts.begin();
  forEachCount(sum, [&](const char*, auto& count) {
    count += static_cast<std::decay_t<decltype(count)>>(*next++);
  });
}

// Contacts come pair by pair.
std::int64_t pairsIn(const std::vector<physics::ContactReport>& contacts) {
  std::int64_t pairs = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    pairs += i == 0 || contacts[i].a != contacts[i - 1].a || contacts[i].b != contacts[i - 1].b;
  }
  return pairs;
}

// What World::memory calls an effect.
std::string effectOf(const std::string& held) {
  if (held == "gyroscopic") return "gyroscopic_torque";
  return held == "stepping" ? "second_order" : held;
}

// All but which bodies.
auto sameOf(const PlannedIslands& island) {
  const physics::IslandPlan& p = island.plan;
  const physics::AccuracyReport steps =
      island.steps ? island.steps->steps : physics::AccuracyReport{};
  return std::tuple(p.bodies, p.flies, p.trees, p.loops, p.joints, p.ropes, p.cloths, p.meshes,
                    p.links, p.contacts, p.atOnce, p.softContacts, p.substeps, p.sweeps, p.law,
                    steps.accepted, steps.order);
}

using Islands = std::map<physics::BodyId, PlannedIslands>;

std::vector<PlannedIslands> grouped(const Islands& islands) {
  std::vector<PlannedIslands> groups;
  for (const auto& entry : islands) {
    const auto& island = entry.second;
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const PlannedIslands& group) {
      return sameOf(group) == sameOf(island);
    });
    if (found == groups.end()) {
      groups.push_back({1, island.plan, island.steps});
    } else {
      ++found->count;
    }
  }
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) {
    return a.count * a.plan.bodies > b.count * b.plan.bodies;
  });
  return groups;
}

}  // namespace

void countWork(const scenes::Scene& scene, Plan& plan) {
  scenes::Simulation simulation(scene);
  Islands islands;
  const physics::IslandListening listening(
      [&](const physics::IslandPlan& plan) { islands[plan.first].plan = plan; });
  const physics::StepListening accurate(
      [&](const physics::IslandSteps& told) { islands[told.first].steps = told; });
  simulation.advance();
  physics::StepWork sum;
  std::int64_t kept = 0;
  for (int k = 0; k < plan.step.steps; ++k) {
    islands.clear();
    add(simulation.advance().work, sum);
    kept += pairsIn(simulation.world().contacts());
  }
  plan.islands = grouped(islands);
  const double steps = std::max(1, plan.step.steps);
  plan.pairsTested = static_cast<double>(sum.narrowPhase) / steps;
  plan.pairsKept = static_cast<double>(kept) / steps;
  forEachCount(sum, [&](const char* name, const auto& count) {
    plan.work[name] = static_cast<double>(count) / steps;
  });
  for (const physics::EffectMemory& held : simulation.world().memory()) {
    plan.bytes += held.bytes;
    for (PlannedEffect& planned : plan.effects) {
      if (planned.effect.name == effectOf(held.effect)) planned.bytes += held.bytes;
    }
  }
}

}  // namespace app
