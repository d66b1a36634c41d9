// Closed forms: round cores against each other, a point against anything, anything against a plane.
#pragma once

#include "physics/collision/contacts.h"

namespace physics::collision {

// All fill `contacts` and return the signed distance of the surfaces [m]. touchRound() does not
// fill them where it is above `reach`.
double touchRound(const Solid& a, const Solid& b, const Relative& pose, double reach,
                  Contacts& contacts);
double touchPoint(const Solid& a, const Solid& b, const Relative& pose, Contacts& contacts);
double touchPlane(const Solid& a, const Solid& plane, const Relative& pose, Contacts& contacts);

// How nearly parallel two lines must be to touch in two points [m]: the most they part at an end.
double flatness(const Solid& a, const Solid& b);

}  // namespace physics::collision
