// Local substeps: islands that need the same number of substeps make a group, and groups step one
// after the other, each from contacts found once for the whole step.
//   need    an island begins with all of Settings::substeps; after each step its error e is looked
//           at: the largest of its constraints [m or rad] and of its overlaps. An error of
//           constraints goes with h^2, so that n sqrt(e/tolerance) substeps are asked for, and half
//           as many are enough once e is below an eighth of the tolerance for some steps.
//   forces  w h <= 1/2, w^2 = K A the stiffest of its springs; a spin turns by 1 rad at the most
//   own     a body's `substeps` is the least for its island
// Numbers are powers of two, or all of Settings::substeps. Where a group meets a body of another
// one in the middle of the step, the step is made anew with the two islands as one.
#pragma once

#include "physics/state/world_state.h"

namespace physics {

// True where the World's islands may take fewer substeps than others.
bool stepsLocally(const Settings& settings);

// The groups of this step, with their contacts. Without local substeps: none, and all bodies that
// are awake step together.
void takeGroups(WorldState& world);

// What now steps: `group` in place of everything, and back. No group: everything.
void enter(WorldState& world, Group& group);
void leave(WorldState& world, Group& group);

// Islands of all that is awake, by what is watched.
void joinAll(WorldState& world);

// After the last group: contacts are together again.
void leaveGroups(WorldState& world);

// After a step: how many substeps each island is to take in the next one.
void askForSubsteps(WorldState& world);

}  // namespace physics
