// What the default method does with each island, told to whoever listens.
#include "physics/small_steps/island_plan.h"

#include <map>

#include "physics/small_steps/small_steps_impl.h"

namespace physics {
void SmallSteps::Impl::countParts(const Batch& batch, std::map<BodyId, IslandPlan>& plans) const {
  for (const int k : batch.articulations) {
    IslandPlan& plan = plans[islands[articulations[k].bodies().front()]];
    ++(articulations[k].hasLoop() ? plan.loops : plan.trees);
    plan.joints += static_cast<int>(articulations[k].size());
  }
  for (const int k : batch.deformables) {
    IslandPlan& plan = plans[islands[deformables[k].bodies().front()]];
    ++(deformables[k].isDirect()          ? plan.ropes
       : deformables[k].hasPointsAtOnce() ? plan.cloths
                                          : plan.meshes);
    plan.links += static_cast<int>(deformables[k].size());
  }
}

// After divide.
void SmallSteps::Impl::tell(const Model& w) const {
  if (!IslandListening::isHeard()) return;
  std::map<BodyId, IslandPlan> plans;
  for (const BodyId i : w.bodies.active) {
    IslandPlan& plan = plans[islands[i]];
    if (plan.bodies++ == 0) plan.first = i;
    plan.flies = batchOf[i] < 0;
    if (plan.flies) continue;
    plan.substeps = substeps[islands[i]];
    plan.sweeps = sweeps[islands[i]];
    if (asked[i] == plan.substeps && asked[i] > leastOf(w, i)) plan.law = law[i];
  }
  for (std::size_t k = 0; k < batchCount; ++k) {
    countParts(batches[k], plans);
    for (const int c : batches[k].contacts) {
      IslandPlan& plan = plans[rootOf(w, contacts[c])];
      ++plan.contacts;
      plan.atOnce = batches[k].isAtOnce;
    }
    for (const SoftPair& pair : batches[k].softPairs) {
      ++plans[islands[softMoverOf(w, pair)]].softContacts;
    }
  }
  for (const auto& [root, plan] : plans) IslandListening::tell(plan);
}

}  // namespace physics
