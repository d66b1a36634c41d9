// Second-order steppings beside the paper's: the free motion of a substep, how an orientation
// follows from the angular momentum that the solve gave, and the velocities at the end. NOTES 6
//
//   bdf2       backward Euler with h^ = 2h/3 from  x^ = x_n + (x_n - x_{n-1})/3,
//              v^ = (4 v_n - v_{n-1})/3, which is the formula
//              v_{n+1} = (3 x_{n+1} - 4 x_n + x_{n-1})/(2h)
//              turning: q^ = exp(theta_n/3) q_n,  q_{n+1} = exp(psi) q^,  w_{n+1} = psi/h^,
//              I(q_{n+1}) psi = h^ (4 L_n - L_{n-1})/3 + h^2 tau + J^T lambda
//   symmetric  x_{n+1} = x_n + h (v_n + h a/2) + M^-1 J(x_n)^T lambda, then half a kick more, and
//              velocities projected on J v = 0 (RATTLE)
//              turning: L = L_n + h tau/2 + J_n^T lambda/h, a free turn by the midpoint rule with
//              that L, and half a kick more at the end
//
// Both solve the balance of angular momentum itself, in the world, so that what the constraints
// exchange is kept. A displacement by I^-1 J^T lambda satisfies it to h^2 only: one order too low.
#pragma once

#include "physics/motion/free_motion.h"

namespace physics {

void makeRoom(SecondOrder& second, std::span<const Pose> pose);

// As moveFreely, each body by its scheme. `h` is the substep.
void moveFreelySecondOrder(Bodies& bodies, std::span<const Load> loads,
                           const std::optional<Vec3>& gravity, double h);

// Every orientation to what target and twist ask for; or those of one scheme alone.
void balance(Bodies& bodies);
void balance(Bodies& bodies, Scheme scheme);

// What is still missing in I psi = h^ L of a body that steps by bdf2, in the units of lambda.
Vec3 missingTwist(const Bodies& bodies, BodyId body);

// Velocities at the end; those of the symmetric scheme are still to be projected.
void finishSecondOrder(Bodies& bodies, std::span<const Load> loads,
                       const std::optional<Vec3>& gravity);

// The past of the next substep. `smooth`: by body, no velocity jumped.
void remember(Bodies& bodies, const std::vector<bool>& smooth);

// The body was moved from outside: it has no past.
void forgetPast(SecondOrder& second, BodyId body);

// Back to X^t, v^t, to make the substep anew.
void rewind(Bodies& bodies);

Vec3 angularMomentum(const Bodies& bodies, BodyId body, const Vec3& w);  // R I R^T w

}  // namespace physics
