// Restitution: a contact that closed faster than a threshold opens again at e times the speed.
#pragma once

#include "physics/constraints/contact.h"

namespace physics {

// After the velocities are known; `threshold` [m/s] keeps resting contacts from buzzing.
void restitute(Contacts& contacts, Bodies& bodies, double restitution, double threshold);

}  // namespace physics
