// Turns and torques in the units of a body's lane, in which its inertia is one.
#pragma once

#include "physics/base/types.h"
#include "physics/solver/contact_block.h"

namespace physics {

// M^-1 of a body: 1/kg, and the inverse inertia in the world.
struct JointMass {
  double inverse = 0;
  Mat3 inertia = Mat3::Zero();
};

LaneMass laneMassOf(const JointMass& mass);

// theta = root turn, and back
Vec3 rotationOf(const LaneMass& mass, const Vec3& turn);
Vec3 turnOf(const LaneMass& mass, const Vec3& theta);
// The torque that gives this turn where nothing but the inertia is in its way: root^-T turn.
Vec3 torqueOf(const LaneMass& mass, const Vec3& turn);

}  // namespace physics
