// Islands that step by an accuracy and touch nothing.
#include <algorithm>

#include "physics/base/profile.h"
#include "physics/small_steps/island_plan.h"
#include "physics/small_steps/small_steps_impl.h"

namespace physics {
namespace {

Surroundings surroundingsOf(Model& w, double time) {
  return {w.kinds, w.bodies, w.loads, w.settings.gravity.value_or(Vec3::Zero()), time};
}

}  // namespace

// `rows`: what joins and pushes, by first body of its island.
void SmallSteps::Impl::learnAccurate(Model& w, const std::vector<std::vector<JointRef>>& rows) {
  accurate.clear();
  accurateOf.assign(w.bodies.pose.size(), -1);
  if (!w.settings.accuracy) return;
  std::vector<std::vector<BodyId>> members(rows.size());
  for (BodyId i = 0; i < w.bodies.size(); ++i) {
    if (w.bodies.motion[i] == Motion::kDynamic) members[w.joined[i]].push_back(i);
  }
  const Surroundings world = surroundingsOf(w, w.time());
  for (BodyId root = 0; root < w.bodies.size(); ++root) {
    const auto& bodies = members[root];
    if (bodies.empty() || !SymmetricStep::takes(rows[root], world)) continue;
    const bool isRound =
        w.bodies.inverseInertia[root].isZero(0) || isIsotropic(w.bodies.inertia[root]);
    if (rows[root].empty() && isRound) continue;  // it flies exactly
    const auto isSoft = [&](BodyId i) { return !w.bodies.isSoft.empty() && w.bodies.isSoft[i]; };
    if (std::any_of(bodies.begin(), bodies.end(), isSoft)) continue;
    accurateOf[root] = static_cast<int>(accurate.size());
    Extrapolation motion(SymmetricStep(rows[root], bodies, world, topologies));
    IslandState state;
    state.pose.resize(motion.step().bodies().size());
    state.velocity.resize(state.pose.size());
    accurate.push_back({std::move(motion), std::move(state)});
  }
  trialNow = trialStart = trialEnd = w.bodies.pose;
}

// They join nothing, and the lanes of contacts are free of joints.
void SmallSteps::Impl::takeForces(Model& w) {
  for (const ConstantForce& push : std::get<Kind<ForceDef, ConstantForce>>(w.kinds).set.items) {
    if (!isLoad(w, push)) continue;
    w.loads[push.bodies[0]].force += push.force;
    w.loaded.push_back(push.bodies[0]);
  }
}

// False: nothing is changed.
bool SmallSteps::Impl::advanceAccurately(Model& w, BodyId root, double dt, AccuracyReport& report) {
  if (accurateOf[root] < 0) return false;
  Accurate& island = accurate[accurateOf[root]];
  const auto bodies = island.motion.step().bodies();
  Bodies& b = w.bodies;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    island.state.pose[i] = b.pose[bodies[i]];
    island.state.velocity[i] = b.velocity[bodies[i]];
  }
  AccuracyReport of;
  profileScope(island.motion.step().isJoined() ? "direct" : "motion");
  const bool isMade =
      island.motion.advance(island.state, dt, *w.settings.accuracy, surroundingsOf(w, now),
                            {trialNow, trialStart, trialEnd}, of);
  profileScope("");
  if (!isMade) return false;
  int moving = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!island.motion.step().moves(i)) continue;
    ++moving;
    b.start[bodies[i]] = b.pose[bodies[i]];
    b.pose[bodies[i]] = island.state.pose[i];
    b.velocity[bodies[i]] = island.state.velocity[i];
  }
  StepListening::tell(
      {root, moving, dt, island.motion.step().size(), kShareOfFrame * *w.settings.accuracy, of});
  add(of, report);
  return true;
}

// Those that no contact, of points neither, may push now.
void SmallSteps::Impl::advanceAccurately(Model& w, AccuracyReport& report) {
  if (accurate.empty()) return;
  const auto meetsSoft = [&](BodyId root) {
    return std::any_of(softPairs.begin(), softPairs.end(),
                       [&](const SoftPair& pair) { return islands[softMoverOf(w, pair)] == root; });
  };
  for (const BodyId i : w.bodies.active) {
    const BodyId root = islands[i];
    if (i != root || held[root] == Held::kTouching || meetsSoft(root)) continue;
    if (advanceAccurately(w, root, w.settings.dt, report)) batchOf[root] = kByItself;
  }
}

}  // namespace physics
