// What a Newton step of the direct method does to the bodies.
#pragma once

#include "physics/sweep/sweep_model.h"

namespace physics {

// From SweepModel::jointChange, the change of every joint's multipliers.
void applyNewtonStep(SweepModel& world);

}  // namespace physics
