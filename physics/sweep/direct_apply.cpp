// A Newton step's displacements, shortened where it is too long to be true.
#include "physics/sweep/direct_apply.h"

#include <algorithm>
#include <cmath>

#include "physics/model/islands.h"
#include "physics/sweep/direct_joints.h"

namespace physics {
namespace {

// A Newton step is linear in the turns: an island whose bodies it would turn further makes the part
// of it that does not.
constexpr double kFarthestTurn = 0.5;  // rad

void shorten(SweepModel& world) {
  const auto turnOf = [&](BodyId i) { return world.jointMotion[i].torque.norm(); };
  const auto isTooFar = [&](BodyId i) {
    return turnOf(i) > kFarthestTurn && std::isfinite(turnOf(i));
  };
  const std::vector<BodyId>& active = world.bodies.active;
  if (std::none_of(active.begin(), active.end(), isTooFar)) return;
  const Islands& islands = jointIslands(world);
  std::vector<double> farthest(world.bodies.pose.size(), 0.0);
  for (const BodyId i : active) farthest[islands[i]] = std::max(farthest[islands[i]], turnOf(i));
  const auto part = [&](BodyId i) {
    return kFarthestTurn / std::max(kFarthestTurn, farthest[islands[i]]);
  };
  for (const BodyId i : active) {
    world.jointMotion[i].impulse *= part(i);
    world.jointMotion[i].torque *= part(i);
  }
  for (std::size_t k = 0; k < world.jointRows.size(); ++k) {
    const auto& bodies = world.jointRows[k].bodies;
    world.jointChange[k] *= part(isMovable(world.bodies, bodies[0]) ? bodies[0] : bodies[1]);
  }
}

// What the changes of all multipliers do to the bodies is added to their impulse and torque, which
// from here on are the displacement of this Newton step.
void addResponses(SweepModel& world) {
  for (std::size_t k = 0; k < world.jointRows.size(); ++k) {
    const JointRows& joint = world.jointRows[k];
    for (int b = 0; b < 2; ++b) {
      JointMotion& m = world.jointMotion[joint.bodies[b]];
      m.impulse += joint.responseLinear[b] * world.jointChange[k];
      m.torque += joint.responseAngular[b] * world.jointChange[k];
    }
  }
  shorten(world);
}

}  // namespace

void applyNewtonStep(SweepModel& world) {
  for (JointMotion& m : world.jointMotion) {
    m.impulse = -m.lagLinear;
    m.torque = -m.lagAngular;
  }
  addResponses(world);
  forEachJoint(world, [&](auto&, auto& lambda, auto&, std::size_t k) {
    lambda.total += world.jointChange[k]
                        .template head<std::decay_t<decltype(lambda.total)>::RowsAtCompileTime>();
  });
  for (const BodyId i : world.bodies.active) {
    JointMotion& m = world.jointMotion[i];
    if (world.bodies.inverse[i].m == 0) continue;
    m.dx += m.impulse;
    m.dtheta += m.torque;
    world.bodies.shift[i] += m.impulse;
    displace(world.bodies.pose[i], m.impulse, m.torque);
  }
}

void followCorrections(SweepModel& world) {
  const auto follows = [](const JointRows& joint) { return !joint.once.isZero(0); };
  if (std::none_of(world.jointRows.begin(), world.jointRows.end(), follows)) return;
  world.joints.solve(world.jointRows, &JointRows::once, world.jointChange);
  for (JointMotion& m : world.jointMotion) {
    m.impulse.setZero();
    m.torque.setZero();
  }
  addResponses(world);
  for (const BodyId i : world.bodies.active) {
    const JointMotion& m = world.jointMotion[i];
    if (world.bodies.inverse[i].m == 0) continue;
    world.bodies.correction[i].dx += m.impulse;
    world.bodies.correction[i].dtheta += m.torque;
    displace(world.bodies.pose[i], m.impulse, m.torque);
  }
}

}  // namespace physics
