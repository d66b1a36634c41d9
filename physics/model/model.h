// What a method of stepping is handed: bodies, what joins, pushes and touches them, and the
// settings. It does not see the World, nor what other methods keep.
#pragma once

#include "physics/base/workers.h"
#include "physics/collision/collider.h"
#include "physics/constraints/contact.h"
#include "physics/constraints/kinds.h"
#include "physics/constraints/soft_contact.h"
#include "physics/model/islands.h"
#include "physics/model/report.h"
#include "physics/model/settings.h"
#include "physics/model/sleep.h"
#include "physics/motion/free_motion.h"
#include "physics/motion/restitution.h"

namespace physics {

// By body, Model::activeMask.
enum Activity : char { kActive, kFixed, kInactive };

struct Model {
  Settings settings;
  Workers workers;
  std::int64_t stepCount = 0;
  Bodies bodies;
  std::vector<Load> loads;     // for the next step, cleared after it
  std::vector<BodyId> loaded;  // those that have one
  Kinds kinds;
  Collider collider;
  Contacts contacts;
  SoftCollider softCollider;
  std::vector<SoftContact> softContacts;
  std::vector<Velocity> velocityBefore;  // free of contacts, restitution only
  std::vector<Pose> ahead;       // scratch: poses at the end of the step, as far as now is known
  Islands joined;                // by constraints; empty: not known yet
  std::vector<bool> attached;    // by body: a constraint holds or pushes it; empty: not known yet
  Sleep sleep;                   // where bodies may
  std::vector<char> activeMask;  // by body, filled where some are skipped: of the present substep
  int substeps = 1;              // of what now steps
  int substep = 0;               // the present one
  bool hasShapes = false;        // the colliders have them
  bool touches = false;          // something can

  double substepLength() const { return settings.dt / substeps; }
  double time() const {
    return static_cast<double>(stepCount) * settings.dt;
  }  // of the step's start

  // Before contacts are first looked for, when it is known which points a soft surface touches for.
  void takeShapes();
  const std::vector<bool>& findAttached();
  FreeFlight flight(double dt);  // what restitution takes for granted, from velocityBefore
  void takeActiveMask();         // of who steps now

  void ignore(BodyId a, BodyId b) {
    if (!settings.contact) return;
    collider.ignore(a, b);
    softCollider.ignore(a, b);
    softCollider.ignore(b, a);
  }
};

// Islands by constraints alone; worked out once.
const Islands& jointIslands(Model& model);

}  // namespace physics
