// What the tests of generators count and weigh.
#pragma once

#include <string>

#include "physics/world.h"

namespace physics::testing {

inline int countOf(const World& world, const std::string& kind) {
  for (const KindError& error : world.constraintErrors()) {
    if (error.kind == kind) return error.count;
  }
  int count = 0;  // forces have no error
  for (const JointReport& joint : world.joints()) count += joint.kind == kind ? 1 : 0;
  return count;
}

inline double massOf(const World& world) {
  double mass = 0;
  for (const double m : world.bodies().mass) mass += m;
  return mass;
}

inline Vec3 placeOf(const World& world, BodyId body) { return world.bodies().pose[body].x; }

}  // namespace physics::testing
