// A substep of bodies in contact gains no energy.
// Backward Euler's own steps obey
//   K' - K <= h sum m g.v' + sum lambda J v' / h,  over forces and motors
// where its constraints hold at both ends; sweeps that leave errors behind, which the next substep
// takes for motion, do not. Where an island has gained, its motion relative to its rigid part is
// scaled, v <- V + s (v - V) with V of the same linear and angular momentum: both are kept, joints
// that hold go on holding. What static bodies gave is scaled as well where that does not suffice.
// Islands with kinematic bodies are left alone: what those do is not known. Where nothing is joined
// small gains are left as well, for bodies that settle on each other.
#pragma once

#include "physics/state/world_state.h"

namespace physics {

// Takes down the kinetic energy at the start of the substep, where bodies may be in contact.
void noteKineticEnergy(WorldState& world);

// After the velocities, before restitution. Returns how many islands were held back.
int boundEnergy(WorldState& world, double h);

}  // namespace physics
