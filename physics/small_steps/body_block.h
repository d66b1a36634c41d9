// How bodies lie side by side where contacts alone hold them, eight to a block, and what moves them
// through a substep. Plain numbers: it is compiled for several machines, and all give the same
// bytes.
#pragma once

#include "physics/solver/joint_block.h"

namespace physics {

// Of symmetric matrices xx yy zz xy xz yz; of triangular ones 00 10 20 11 21 22; turns w, x, y, z.
struct BodyBlock {
  static constexpr int kLanes = 8;
  using Lanes = Num<kLanes>;
  // Of the step; 1 or 0. What moves is moved by forces, what is turned by torques, and of what
  // turns the inertia turns with it.
  Lanes moves, isTurned, turns;
  Lanes h, rate;                        // of its substep [s], and 1 over that
  Lanes inertia[3], inverseInertia[3];  // principal
  Lanes q[4], w[3];                     // and its spin, pushed by loads
  // What it moves by in this substep, and turned by without contacts. Before predict() u is the
  // speed, after end() u and theta are speed and spin.
  Lanes u[3], theta[3], spin[3];
  Lanes inverse[6], startInertia[6];  // of the world: now, and M at the substep's start
  // Turns in the units of contacts' lanes: theta = root turn.
  Lanes root[6], inverseRoot[6];
  // What the lanes of contacts say now, and did when the body last knew of them.
  Lanes nowU[3], nowTurn[3], knownU[3], knownTurn[3];
  Lanes sinceRows[3];  // turns since rows were prepared; after displace() of theta, squared
};

struct BodyKernels {
  // u = h v, with the inertia at the start.
  void (*predict)(BodyBlock& bodies);
  // `nowTurn` of theta, and `nowU`.
  void (*give)(BodyBlock& bodies);
  // Takes what contacts gave, and turns by theta; then `nowTurn` of theta where the inertia turned,
  // and sinceRows[0] is the square of how far it has turned since rows were prepared [rad^2].
  void (*displace)(BodyBlock& bodies);
  // Takes what contacts gave, and speeds are u / h.
  void (*end)(BodyBlock& bodies);
};

const BodyKernels& bodyKernels();  // chosen once, by what the processor has
extern const BodyKernels kBodyKernelsSse2, kBodyKernelsAvx2, kBodyKernelsAvx512;

// rad: what turns further in a substep is turned as it would turn freely: to second order in the
// step it would gain energy.
constexpr double kResolvedTurn = 0.1;
// The mean spin of a substep of such a body, in the world.
void freeSpin(const double (&inertia)[3], const double (&q)[4], double h, double (&w)[3]);

}  // namespace physics
