// The choice of a scheme for every body's substep, and whether the solve bears it out. stepping.h
#pragma once

#include "physics/world_impl.h"

namespace physics {

// True where the World steps by a second-order scheme.
bool isSecondOrder(const Settings& settings);

// Before the free motion.
void chooseSchemes(World::Impl& world);

// After the solve: true where the substep has to be made anew, with schemes already lowered.
bool lowerSchemes(World::Impl& world, double h);

// What a solve tells, body by body: Stepper's smooth, parted, bounded and unresolved.
void inspectMotion(World::Impl& world, double h);
bool isLoaded(const ContactPair& pair);
double jumpSpeed(const World::Impl& world, double h);  // what gravity gives in two substeps [m/s]
bool jumps(const ContactPair& pair, double speed);     // it began, closing faster than that

// What a contact has changed of its bodies' relative speed in this substep [m/s].
double speedGiven(const World::Impl& world, const ContactPair& pair);

// The paper's scheme for everything, which no contact that is found late can make wrong.
void stepByPaper(World::Impl& world);

// At the end of a substep: what the next one needs to know, and what is counted.
// `jumped`: bodies whose velocities a bounce changed; may be empty.
void recordSchemes(World::Impl& world, const std::vector<bool>& jumped, StepReport& report);

}  // namespace physics
