// Sleep: an island whose bodies have all been slow for a while is left alone, until something
// touches it or acts on it.
//   slow     sqrt(v^2 + w^2 I/m) < speed, I the largest moment: the speed that holds all its energy
//   asleep   its velocities are zero, its multipliers stay: it wakes as it fell asleep
//   woken    with its whole island: by a manifold with a body that is awake, by a body moved or
//            loaded from outside, by a new target of its drive
// What it changes: a body that would go on slower than `speed` stands still.
#pragma once

#include <span>
#include <vector>

#include "physics/constraints/contact.h"
#include "physics/world.h"

namespace physics {

struct Sleep {
  std::vector<int> still;             // by body: steps in a row that it was slow
  std::vector<char> asleep;           // by body
  std::vector<BodyId> island;         // by body: the first of the island that it fell asleep with
  std::vector<BodyId> called;         // to be woken before the next step
  std::vector<ContactPair> contacts;  // of bodies that sleep; sorted
  int count = 0;                      // of those that sleep
};

// True where the World's bodies may fall asleep: rivals and the linear method never rest.
bool sleeps(const Settings& settings);

// After a step.
void fallAsleep(World::Impl& world, StepReport& report);

// Its island steps again, from the next step on.
void callAwake(World::Impl& world, BodyId body);
void wakeCalled(World::Impl& world);

}  // namespace physics
