// Turns and torques in the units of a body's lane, in which its inertia is one.
#pragma once

#include <cstring>
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

// The lanes of contacts, by slot; and the slots, by body.
struct LaneBodies {
  std::span<const int> slotOf;
  std::span<LaneMotion> motions;
  std::span<LaneStart> before;
  std::span<const LaneMass> masses;
  std::span<const LaneInverse> inverses;

  // Whether contacts have changed anything since the body last knew: most of a figure touches
  // nothing.
  bool isChanged(int slot) const {
    const LaneMotion& lane = motions[slot];
    const LaneStart& start = before[slot];
    return std::memcmp(lane.u, start.u, sizeof lane.u) != 0 ||
           std::memcmp(lane.turn, start.turn, sizeof lane.turn) != 0;
  }
  // Adds it: what they leave alone stays as it was, to the last bit. Without `theta` nothing turns
  // the body.
  void take(int slot, Vec3& u, Vec3* theta) const;
  void give(int slot, const Vec3& u, const Vec3& theta) const;
};

LaneMass laneMassOf(const JointMass& mass);
LaneInverse inverseOf(const LaneMass& mass);

// theta = root turn, and back
inline Vec3 rotationOf(const LaneMass& mass, const Vec3& turn) {
  const auto& r = mass.root;
  return {r[0] * turn.x(), r[1] * turn.x() + r[3] * turn.y(),
          r[2] * turn.x() + r[4] * turn.y() + r[5] * turn.z()};
}
inline Vec3 turnOf(const LaneInverse& inverse, const Vec3& theta) {
  const auto& i = inverse.entries;
  return {i[0] * theta.x(), i[1] * theta.x() + i[3] * theta.y(),
          i[2] * theta.x() + i[4] * theta.y() + i[5] * theta.z()};
}

// The torque that gives this turn where nothing but the inertia is in its way: root^-T turn.
Vec3 torqueOf(const LaneMass& mass, const Vec3& turn);

// `then` becomes `now`.
inline Vec3 changeSince(float (&then)[3], const float (&now)[3]) {
  Vec3 by;
  for (int k = 0; k < 3; ++k) {
    by[k] = double(now[k]) - then[k];
    then[k] = now[k];
  }
  return by;
}

inline void LaneBodies::take(int slot, Vec3& u, Vec3* theta) const {
  const LaneMotion& lane = motions[slot];
  u += changeSince(before[slot].u, lane.u);
  if (theta) *theta += rotationOf(masses[slot], changeSince(before[slot].turn, lane.turn));
}

inline void LaneBodies::give(int slot, const Vec3& u, const Vec3& theta) const {
  LaneMotion& lane = motions[slot];
  LaneStart& start = before[slot];
  const Vec3 turn = turnOf(inverses[slot], theta);
  for (int k = 0; k < 3; ++k) {
    start.u[k] = lane.u[k] = static_cast<float>(u[k]);
    start.turn[k] = lane.turn[k] = static_cast<float>(turn[k]);
  }
}

}  // namespace physics
