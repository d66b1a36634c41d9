// What the rivals share. A rival replaces one whole substep: it takes the bodies from X^t, v^t to
// X^{t+1}, v^{t+1}. The studies compare them with this project's methods on the same scenes.
#pragma once

#include "physics/model/finite.h"
#include "physics/rivals/rival_model.h"
#include "physics/rivals/touch.h"

namespace physics {

bool isRival(Method method);

// Start of a rival's substep: bodies.start is X^t, and bodies.pose where velocities and gravity
// would take the bodies, which is where contacts are looked for.
void coast(RivalModel& world, double dt);

// The substep itself, from X^t: free motion, solve, velocities.
void rivalSubstep(RivalModel& world, double dt, StepReport& report);

// v += h M^-1 f and the gyroscopic torque:
//   explicit   w += h I^-1 (tau - w x I w)        Mueller et al., Detailed Rigid Body Simulation
//   with
//              Extended Position Based Dynamics (2020); gains energy where |w| h is not small
//   implicit   I (w' - w) + h w' x I w' = h tau   one Newton step in the body frame; Catto,
//              Numerical Methods (GDC 2015)
enum class Gyroscopic { kExplicit, kImplicit };
void accelerate(RivalModel& world, double dt, Gyroscopic form);

// Poses of a substep from bodies.start by its velocities: x + h v, exp(h w) q.
void advance(Bodies& bodies, double dt);

// Restitution by the rule that all methods of this project share (restitution.h).
void bounce(RivalModel& world, double dt);

// Calls f(touch, normalTotal, frictionTotal, pair point or nullptr) for every contact point at the
// present poses, in order; where f returns false it stops and names that contact.
template <class F>
bool forEachTouch(RivalModel& world, StepReport& report, F&& f) {
  Bodies& bodies = world.bodies;
  for (std::size_t i = 0; i < world.contacts.pairs.size(); ++i) {
    ContactPair& pair = world.contacts.pairs[i];
    for (int k = 0; k < pair.count; ++k) {
      ContactPointState& p = pair.points[k];
      if (f(touchOf(pair, k, bodies.pose), p.normalTotal, p.frictionTotal, &p)) continue;
      nameCulprit(report, "contact", i, pair.a);
      return false;
    }
  }
  for (std::size_t i = 0; i < world.softContacts.size(); ++i) {
    SoftContact& contact = world.softContacts[i];
    ContactPointState* const none = nullptr;
    if (f(touchOf(contact, bodies), contact.normalTotal, contact.frictionTotal, none)) continue;
    nameCulprit(report, "soft contact", i, contact.body);
    return false;
  }
  return true;
}

// Visits to contacts in one sweep: a manifold is one, as in the other methods.
inline std::int64_t contactVisits(const RivalModel& world) {
  return static_cast<std::int64_t>(world.contacts.pairs.size() + world.softContacts.size());
}

void xpbd(RivalModel& world, double dt, StepReport& report);
void sequentialImpulses(RivalModel& world, double dt, StepReport& report);
void penalty(RivalModel& world, double dt, StepReport& report);          // implicit steps
void penaltyExplicit(RivalModel& world, double dt, StepReport& report);  // explicit steps

}  // namespace physics
