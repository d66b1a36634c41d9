// Penalty forces, to compare with: every constraint and contact is a spring and a damper.
//   f = -K c - D dc/dt,  K h^2 = kappa A^-1, D h = 2 zeta sqrt(kappa) A^-1,  A = J M^-1 J^T
// In units of the effective mass every constraint is equally far from the limit of stability.
//   explicit   symplectic Euler; kappa = 1/n where n constraints meet at a body: the sum of n
//              projections M^-1 J^T A^-1 J has eigenvalues up to n, and the scheme bears
//              kappa + 4 zeta sqrt(kappa) < 4
//   implicit   backward Euler, one Newton step per iteration; one iteration is Baraff and Witkin,
//              Large Steps in Cloth Simulation (1998), (M - h D - h^2 K) dv = h (f + h K v), with
//              K = -J^T k J and the geometric stiffness of what is under tension. kappa = 1e4
// Friction: a tangential spring that remembers its stretch, bounded by Coulomb's law; Cundall and
// Strack, A Discrete Numerical Model for Granular Assemblies (1979).
#pragma once

#include <vector>

#include "physics/rivals/penalty_system.h"
#include "physics/rivals/touch.h"

namespace physics {

struct StiffTouch {
  Touch touch;
  std::array<TouchRow, 3> rows;  // the normal, and two for friction
  Vec3 f = Vec3::Zero();         // along the rows, times h^2
  Vec3 k = Vec3::Zero();         // the same
  bool sliding = false;
  bool stopped = false;      // the normal force is more than enough to hold it
  double* normal = nullptr;  // the multipliers, where contacts keep them
  Vec3* friction = nullptr;
  ContactPointState* point = nullptr;  // of a rigid contact
};

struct PenaltySystem {
  std::vector<StiffTouch> touches;
  std::vector<int> meeting;      // constraints and touches at each body
  std::vector<DeltaX> moved;     // h v and h w of every body
  std::vector<Velocity> free;    // v^t + h M^-1 f of what is not a spring
  std::vector<Velocity> change;  // of one Newton step
  std::vector<DeltaX> step;      // the same times h
  SparseMotion matrix;
};

}  // namespace physics
