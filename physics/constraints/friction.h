// Friction is Coulomb's law on a contact's normal multiplier, (101), and this is all of it: what
// two materials make of it, and how much of a tangential multiplier is held. Whoever solves
// contacts finds that multiplier in its own way and asks here; solver/contact_kernels.h says the
// same for eight contacts at a time (`onDisc`), with a row for twist beside the two of friction.
#pragma once

#include <cmath>

#include "physics/bodies/body.h"

namespace physics {

// Geometric means.
inline Friction frictionBetween(const Friction& a, const Friction& b) {
  return {std::sqrt(a.staticCoefficient * b.staticCoefficient),
          std::sqrt(a.dynamicCoefficient * b.dynamicCoefficient)};
}

// The share of a tangential multiplier of this length that `normal` holds: all of it within
// nu_s normal, where the contact sticks; else it slides, with nu_d normal.
inline double heldShare(const Friction& friction, double length, double normal) {
  if (!(length > friction.staticCoefficient * normal)) return 1;
  return friction.dynamicCoefficient * normal / length;
}

}  // namespace physics
