// Sequential impulses, to compare with: a projected Gauss-Seidel on velocities. Catto, Iterative
// Dynamics with Temporal Coherence (GDC 2005) and Fast and Simple Physics using Sequential Impulses
// (GDC 2006), in the form that its author found the best of eight: soft constraints with relaxation
// ("soft step"), Catto, Solver2D (2024), here in three dimensions.
//   v += h M^-1 f;  warm start: v += M^-1 J^T lambda of the last substep
//   solve   lambda <- lambda - m_s A^-1 (J v + b c) - i_s lambda, clamped       A = J M^-1 J^T
//           b = omega/(2 zeta + h omega), m_s = a/(1 + a), i_s = 1/(1 + a),
//           a = h omega (2 zeta + h omega)
//   x += h v
//   relax   the same with b = 0, m_s = 1, i_s = 0 at the new poses: what corrected the error leaves
//           the velocities again
// An inequality that holds may be used up within the substep: J v + c/h >= 0. Springs, drives and
// compliances are soft with gamma and beta of their own, which is the implicit K of Push.
#pragma once

#include <vector>

#include "physics/rivals/touch.h"

namespace physics {

struct ImpulseTouch {
  Touch touch;
  std::array<TouchRow, 3> rows;  // the normal, and two for friction
  bool onFixed = false;          // one of the two cannot move
  double* normal = nullptr;      // the accumulated impulses, where contacts keep them
  Vec3* friction = nullptr;
};

// The accumulated impulses are the multipliers of the constraints and contacts, times h.
struct ImpulseSystem {
  std::vector<ImpulseTouch> touches;
  std::vector<DeltaX> moved;  // h v and h w of every body
};

}  // namespace physics
