// What a World tells about an arm between steps.
#pragma once

#include <vector>

#include "physics/base/types.h"

namespace physics {

// Vectors over joints go from the root to the tip; d_ij = centres[j] -
// pivots[i].
struct ArmReport {
  std::vector<BodyId> bodies;  // of the links
  Vec3 tip, target;
  Vec3 followed;               // where the target is as far as max_speed lets the tip know
  double error;                // |tip - target| [m]
  std::vector<Vec3> pivots;    // world
  std::vector<Vec3> toTip;     // s_i
  std::vector<Vec3> centres;   // of mass
  std::vector<Mat3> inertia;   // M_i (151), world frame [kg m^2]
  std::vector<Vec3> turns;     // of the last step, in each joint's parent's frame [rad]
  std::vector<double> turned;  // since the start, |log| of the whole turn, or |angle| [rad]
  double effort;               // sum of 1/2 dtheta^T M dtheta since the start [kg m^2 rad^2]
  int iterations, held;        // of the last step; held: joints at a limit that push on
};

}  // namespace physics
