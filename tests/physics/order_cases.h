// Small worlds in smooth motion, one for each kind of constraint and force: what the order of a
// stepping is measured on.
#pragma once

#include <string>
#include <vector>

#include "physics/world.h"

namespace physics::testing {

struct OrderCase {
  std::string name;
  World (*make)(const Settings& settings);
};
std::vector<OrderCase> orderCases();

inline std::ostream& operator<<(std::ostream& out, const OrderCase& c) { return out << c.name; }

// Settings of a run in `steps` substeps of `duration` seconds.
Settings smoothSettings(Stepping stepping, Method method, double duration, int steps);

// Largest distance of positions [m] and orientations [rad] of two worlds' bodies.
double distanceOf(const World& a, const World& b);

// log2 of how much a halving of the step lowers the error, by three runs. `steps`: of the coarsest.
double selfConvergence(const OrderCase& c, Stepping stepping, Method method, int steps);

}  // namespace physics::testing
