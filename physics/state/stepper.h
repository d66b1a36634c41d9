// Which scheme each body's substep takes. Bodies that are joined or touch take the same one, so
// that what they exchange is kept:
//   bdf2       where the last substep was smooth
//   symmetric  where nothing touches, no limit is at work, and the substep resolves the motion
//   paper      else: where a contact or a limit begins and velocities jump, and where a contact
//              ends that did: bdf2 would go on with a third of a force that has no partner any more
// The World's own one comes first. The symmetric scheme needs no past, so that it starts bdf2 as
// well. A substep whose solve finds out that its scheme was the wrong one is made anew.
#pragma once

#include <vector>

#include "physics/bodies/body.h"

namespace physics {

// The schemes that a body's state allows.
struct Allowed {
  bool bdf2 = false;       // its last substep was smooth
  bool symmetric = false;  // it is free to move, and the substep resolves its motion
};

struct Stepper {
  std::vector<BodyId> island;    // by body: the first body of its island in this substep
  std::vector<Allowed> allowed;  // by body
  std::vector<bool> smooth;      // by body: no velocity jumped in this substep
  std::vector<bool> parted;      // by body: a contact that bore load bears none now
  std::vector<bool> unresolved;  // by body: the symmetric scheme would not resolve its motion
  std::vector<bool> bounded;     // by body: it touches, or is held by a limit
  std::vector<Scheme> tried;     // scratch: by body, before schemes were lowered
  std::vector<double> ratio;     // scratch: by body, h^2 K/m
};

}  // namespace physics
