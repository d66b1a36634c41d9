// The choice of a scheme for every body's substep, and whether the solve bears it out. stepping.h
#pragma once

#include "physics/state/world_state.h"

namespace physics {

// True where the World steps by a second-order scheme.
bool isSecondOrder(const Settings& settings);

// Before the free motion.
void chooseSchemes(WorldState& world);

// After the solve: true where the substep has to be made anew, with schemes already lowered.
bool lowerSchemes(WorldState& world, double h);

// What a solve tells, body by body: Stepper's smooth, parted, bounded and unresolved.
void inspectMotion(WorldState& world, double h);
double jumpSpeed(const WorldState& world, double h);  // what gravity gives in two substeps [m/s]
bool jumps(const ContactPair& pair, double speed);    // it began, closing faster than that

// What a contact has changed of its bodies' relative speed in this substep [m/s].
double speedGiven(const WorldState& world, const ContactPair& pair);

// The paper's scheme for everything, which no contact that is found late can make wrong.
void stepByPaper(WorldState& world);

// At the end of a substep: what the next one needs to know, and what is counted.
// `jumped`: bodies whose velocities a bounce changed; may be empty.
void recordSchemes(WorldState& world, const std::vector<bool>& jumped, StepReport& report);

}  // namespace physics
