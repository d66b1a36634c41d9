// Sleep: an island whose bodies have all been slow for a while is left alone, until something
// touches it or acts on it.
//   slow     sqrt(v^2 + w^2 I/m) < speed, I the largest moment: the speed that holds all its energy
//   asleep   its velocities are zero, its multipliers stay: it wakes as it fell asleep
//   woken    with its whole island: by a manifold with a body that is awake, by a body moved or
//            loaded from outside, by a new target of its drive
// What it changes: a body that would go on slower than `speed` stands still.
#pragma once

#include "physics/state/world_state.h"

namespace physics {

// True where the World's bodies may fall asleep: rivals and the linear method never rest.
bool sleeps(const Settings& settings);

// After a step.
void fallAsleep(WorldState& world, StepReport& report);

// Lists anew what steps, after Sleep::asleep.
void listAwake(WorldState& world);

// Islands of bodies that callAwake() named step again, from now on.
void wakeCalled(WorldState& world);

}  // namespace physics
