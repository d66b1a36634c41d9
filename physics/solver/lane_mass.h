// Turns and torques in the units of a body's lane, in which its inertia is one.
#pragma once

#include <span>

#include "physics/base/types.h"
#include "physics/solver/contact_block.h"

namespace physics {

// M^-1 of a body: 1/kg, and the inverse inertia in the world.
struct JointMass {
  double inverse = 0;
  Mat3 inertia = Mat3::Zero();
};

// The inverse of the root of a LaneMass, by rows.
struct LaneInverse {
  double entries[6] = {};
};

// What a lane moved by when its body last knew of it.
struct LaneStart {
  float u[3] = {}, turn[3] = {};
};

// The lanes of contacts, by slot; and the slots, by body.
struct LaneBodies {
  std::span<const int> slotOf;
  std::span<LaneMotion> motions;
  std::span<LaneStart> before;
  std::span<const LaneMass> masses;
  std::span<const LaneInverse> inverses;

  // Adds what contacts have changed since the body last knew: what they leave alone stays as it
  // was, to the last bit. Without `theta` nothing turns it.
  void take(int slot, Vec3& u, Vec3* theta) const;
  void give(int slot, const Vec3& u, const Vec3& theta) const;
};

LaneMass laneMassOf(const JointMass& mass);
LaneInverse inverseOf(const LaneMass& mass);

// theta = root turn, and back
Vec3 rotationOf(const LaneMass& mass, const Vec3& turn);
Vec3 turnOf(const LaneInverse& inverse, const Vec3& theta);
// The torque that gives this turn where nothing but the inertia is in its way: root^-T turn.
Vec3 torqueOf(const LaneMass& mass, const Vec3& turn);

}  // namespace physics
