// Geometric stiffness of what pulls at a body.
#pragma once

#include "physics/base/types.h"

namespace physics {

// How the torque of a force at an arm turns back with the body: by a turn theta it changes by
//   (theta x r) x f = -((r . f) 1 - r f^T) theta,
// which is -(r . f) theta across the force. Of turns about the force, which move only what the arm
// has across it, it is left out: alone that is a stiffness of either sign, and where two anchors
// beside each other share a pull it is none. Nor is there any of what pushes. Semidefinite.
inline Mat3 pullStiffness(const Vec3& force, const Vec3& arm) {
  const double along = force.dot(arm);
  if (!(along > 0)) return Mat3::Zero();
  return along * (Mat3::Identity() - force * force.transpose() / force.squaredNorm());
}

}  // namespace physics
