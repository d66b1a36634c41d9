// A Newton step's displacements.
#include "physics/sweep/direct_apply.h"

namespace physics {
namespace {

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
}

}  // namespace

void applyNewtonStep(SweepModel& world) {
  for (JointMotion& m : world.jointMotion) {
    m.impulse = -m.lagLinear;
    m.torque = -m.lagAngular;
  }
  addResponses(world);
  for (std::size_t k = 0; k < world.jointRows.size(); ++k) {
    const JointRows& joint = world.jointRows[k];
    for (int r = 0; r < joint.rows; ++r) joint.total[r] += world.jointChange[k][r];
  }
  for (const BodyId i : world.bodies.active) {
    JointMotion& m = world.jointMotion[i];
    if (world.bodies.inverse[i].m == 0) continue;
    m.dx += m.impulse;
    m.dtheta += m.torque;
    world.bodies.shift[i] += m.impulse;
    displace(world.bodies.pose[i], m.impulse, m.torque);
  }
}

}  // namespace physics
