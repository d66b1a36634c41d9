// All that a World holds: the model, and what methods and effects keep from step to step.
#pragma once

#include "physics/kinematics/driven_arm.h"
#include "physics/rivals/rival_model.h"
#include "physics/small_steps/small_steps.h"
#include "physics/state/local.h"
#include "physics/state/stepper.h"

namespace physics {

struct WorldState : RivalModel {
  std::vector<DrivenArm> arms;
  SmallSteps small;                         // small steps only
  Stepper stepper;                          // second-order steppings only
  std::vector<ContactPair> contactsBefore;  // as the substep found them; second order only
  Local local;                              // local substeps only
  int turning = 0;                          // how many of the active bodies a torque can turn
  std::vector<Manifold> own;                // scratch: those found that are of what now steps
  std::vector<std::array<BodyId, 2>> met;   // with the second inactive: the step is made anew

  struct Snapshot {  // the last good state
    std::vector<Pose> pose;
    std::vector<Velocity> velocity;
    // What setVelocity() replaced by something that is not finite, since the last step.
    std::vector<std::pair<BodyId, Velocity>> replaced;
  } last;

  struct {  // the start of a step that may be made anew
    std::vector<ContactPair> contacts;
    std::vector<History> history;
    std::vector<bool> unresolved, bounded;
  } kept;
};

}  // namespace physics
