// Bounds on one side in the direct method: ropes that only pull, limits that only push. A joint
// that does not hold keeps its rows in the system, empty, so that the layout stays.
#pragma once

#include "physics/constraints/constraint_response.h"
#include "physics/sweep/joint_system.h"

namespace physics {

enum class Stage { kDisplacements, kVelocities };

// Whether a bound on one side holds: the primal-dual active set (Hintermueller, Ito and Kunisch,
// "The primal-dual active set strategy as a semismooth Newton method", 2002), lambda - c/A beyond
// the bound of the total.
template <class C>
bool holds(const C& item, const Row<C::kBodies, C::kRows>& row, double lambda,
           const Bodies& bodies) {
  Response<C> response;
  const double a = effectiveMassInverse(item, row, bodies.inverse, response).trace();
  if (!(a > 0)) return false;
  const double wanted = lambda - row.c[0] / a;
  return row.high <= 0 ? wanted < 0 : wanted > 0;
}

// Takes a joint that does not hold out of the system: its rows stay, empty.
inline void release(JointRows& joint) {
  for (int b = 0; b < 2; ++b) {
    joint.linear[b].setZero();
    joint.angular[b].setZero();
  }
  joint.right.setZero();
  joint.error = 0;
}

// Lets go of a one-sided joint that does not hold at the present poses, and notes that it did.
template <class C>
void chooseActive(const C& item, const Row<C::kBodies, C::kRows>& row, Stage stage,
                  const Bodies& bodies, VectorOf<C>& total, JointRows& joint) {
  if constexpr (requires { item.isOneSided(); }) {
    if (!item.isOneSided()) return;
    const bool held = !total.isZero(0);
    const bool holding = stage == Stage::kVelocities ? held : holds(item, row, total[0], bodies);
    joint.side = row.high <= 0 ? -1 : 1;
    joint.changes = held && !holding;
    if (holding) return;
    total.setZero();
    release(joint);
  }
}

}  // namespace physics
