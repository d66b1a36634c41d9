// The springs that stand for constraints and contacts in the penalty methods, taken at one
// configuration.
#pragma once

#include "physics/rivals/penalty.h"
#include "physics/rivals/rival.h"

namespace physics {

struct PenaltyScheme {
  bool implicit = false;
  double kappa = 1;  // K h^2 A
  double delta = 1;  // D h A = 2 zeta sqrt(kappa)
};
PenaltyScheme schemeOf(const Settings& settings, bool implicit);

// world.penalty.moved from the present velocities.
void takeMoved(RivalModel& world, double dt);

// J (h v) of the three rows of a touch.
Vec3 followOf(const StiffTouch& contact, const std::vector<DeltaX>& moved);

// Fills world.frozen and world.penalty.touches at x; `first` in a substep, no force of a contact is
// known yet. False: something was not finite, and report.notFinite names it.
bool takeSprings(RivalModel& world, const Configuration& x, const PenaltyScheme& scheme, bool first,
                 StepReport& report);

}  // namespace physics
