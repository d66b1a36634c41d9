// What a World holds. Private to physics: the step, the builder and the reports share it.
#pragma once

#include "physics/collision/collider.h"
#include "physics/constraints/contact.h"
#include "physics/constraints/soft_contact.h"
#include "physics/effects/free_motion.h"
#include "physics/effects/restitution.h"
#include "physics/effects/sleep.h"
#include "physics/groups.h"
#include "physics/kinds.h"
#include "physics/kinematics/driven_arm.h"
#include "physics/methods/conjugate.h"
#include "physics/methods/joint_system.h"
#include "physics/methods/linear_gauss_seidel.h"
#include "physics/methods/penalty.h"
#include "physics/methods/sequential_impulses.h"
#include "physics/solver/small_steps.h"
#include "physics/stepping.h"
#include "physics/workers.h"
#include "physics/world.h"

namespace physics {

struct World::Impl {
  Settings settings;
  Workers workers;
  std::int64_t stepCount = 0;
  Bodies bodies;
  std::vector<Load> loads;     // for the next step, cleared after it
  std::vector<BodyId> loaded;  // those that have one
  Kinds kinds;
  std::vector<DrivenArm> arms;
  Collider collider;
  Contacts contacts;
  SoftCollider softCollider;
  std::vector<SoftContact> softContacts;
  Conjugate conjugate;  // scratch of the sweeps
  JointSystem joints;   // this and its scratch: the direct method only
  std::vector<JointRows> jointRows;
  std::vector<Vec3> jointChange;
  std::vector<JointMotion> jointMotion;
  double jointError = 0;                    // largest that the last Newton step met [m or rad];
                                            // infinite while its active set changes
  LinearSystem linear;                      // the linear method only
  Stepper stepper;                          // second-order steppings only
  std::vector<ContactPair> contactsBefore;  // as the substep found them; second order only
  ImpulseSystem impulses;                   // sequential impulses only
  SmallSteps small;                         // small steps only
  PenaltySystem penalty;                    // penalty forces only
  std::vector<double> kineticBefore;        // of bodies at the start of the substep [J]; empty
                                            // where energy needs no bound
  std::vector<Velocity> velocityBefore;     // free of contacts, restitution only
  std::vector<Pose> ahead;     // scratch: poses at the end of the step, as far as now is known
  Islands joined;              // by constraints; empty: not known yet
  std::vector<bool> attached;  // by body: a constraint holds or pushes it; empty: not known yet
  Sleep sleep;                 // where bodies may
  Local local;                 // local substeps only
  int turning = 0;             // how many of the active bodies a torque can turn
  int substeps = 1;            // of what now steps
  int substep = 0;             // the present one
  std::vector<char> present;   // by body, filled where some are left out: of the present substep
  std::vector<Manifold> own;   // scratch: those found that are of it
  std::vector<std::array<BodyId, 2>> met;  // with the second left out: the step is made anew

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

  bool hasShapes = false;
  bool touches = false;  // something can
  // Before contacts are first looked for, when it is known which points a soft surface touches for.
  void takeShapes();
  const std::vector<bool>& findAttached();
  FreeFlight flight(double dt);  // what restitution takes for granted, from velocityBefore

  void ignore(BodyId a, BodyId b) {
    if (!settings.contact) return;
    collider.ignore(a, b);
    softCollider.ignore(a, b);
    softCollider.ignore(b, a);
  }
  double substepLength() const { return settings.dt / substeps; }
};

}  // namespace physics
