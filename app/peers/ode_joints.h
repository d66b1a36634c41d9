// ODE's joints, for ode.cpp.
#pragma once

#include <ode/ode.h>

#include "app/peers/blueprint.h"

namespace app {

// `a` and `b` are the bodies of the joint; null: static.
void addOdeJoint(dWorldID world, dBodyID a, dBodyID b, const Blueprint& plan,
                 const PeerJoint& joint);

}  // namespace app
