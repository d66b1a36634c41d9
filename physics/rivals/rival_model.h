// What the rivals keep beside the model. They use nothing of the sweeps': those stand in between
// because one world has both.
#pragma once

#include "physics/rivals/penalty.h"
#include "physics/rivals/sequential_impulses.h"
#include "physics/sweep/sweep_model.h"

namespace physics {

struct RivalModel : SweepModel {
  ImpulseSystem impulses;  // sequential impulses only
  PenaltySystem penalty;   // penalty forces only
};

}  // namespace physics
