// Restitution: a contact that closes faster than a threshold opens again at e times the speed.
//   speed of impact   v_i = -sqrt(v^2 - 2 a c),  time of impact  t_i = (v_i - v)/a
//   v, c: speed along the normal and gap at the start of the substep, a: the acceleration of the
//   free flight. So a bounce neither wins nor loses energy by where in the substep it falls.
//   A contact that nothing else meets flies on for the rest of the substep, tau = h - t_i:
//   c = -e v_i tau + a tau^2/2, v = -e v_i + a tau: the times of bounces are of second order too.
// Bodies that touch hand an impact on: the impulses of the solve, which ends all approach at once,
// are taken back, and pairs hit one another in turn until none approaches (Newton's cradle). Of two
// bodies that hit each other the larger e counts. What a hit is, hit.h tells.
#pragma once

#include <optional>
#include <span>

#include "physics/constraints/contact.h"
#include "physics/motion/free_motion.h"

namespace physics {

inline constexpr double kClose =
    1e-6;  // m: what is nearer than this touches, and hands an impact on

// What a body that is not touched does in a substep.
struct FreeFlight {
  std::optional<Vec3> gravity;  // m/s^2
  std::span<const Load> loads;  // by BodyId
  // by BodyId: at the start of the substep, with its gravity and loads
  std::span<const Velocity> before;
  std::vector<bool> attached;  // by BodyId: more than contacts may have moved it: joints, springs
  double dt = 0;               // the substep [s]
};

// After the velocities are known. Contacts slower than twice what gravity gives in a substep do not
// bounce: that keeps resting ones from buzzing.
// Tells the bodies whose velocities jumped; empty: none did.
std::vector<bool> restitute(const Contacts& contacts, Bodies& bodies, const FreeFlight& flight);

}  // namespace physics
