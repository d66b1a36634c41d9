// Joints in turns with contacts: articulations of gaps and limits, eight side by side, in single
// precision and in the lanes of their contacts. What they aim at is a displacement of a substep,
// counted from where their rows were seen, and is aimed at anew in every turn: what rounding leaves
// of one is taken back by the next. The factor was made in double precision, and what is copied of
// it here is no more than a solve reads, so that a hundred figures stay in the cache of a core. No
// include but what has the lanes: it is compiled for several machines.
#pragma once

#include "physics/solver/contact_block.h"

namespace physics {

struct alignas(32) Eight {
  float v[8] = {};
};

// A body that moves, in each lane; slot 0 where there is none. Inertia is that of the joints, which
// pulls have made stiffer since the lane's units were chosen.
struct TurnBody {
  int slot[8] = {};
  Eight inverseMass;
  Eight root[6];   // theta = root turn: 00 10 20 11 21 22
  Eight given[9];  // the turn that a torque gives, by rows
};

// What a body moves by when a turn begins, and what it is given.
struct TurnMotion {
  Eight u[3], theta[3], push[3], torque[3];
};

// -(off + yields lambda + J (u, theta)) is aimed at. J of a gap is +-1 and the cross product with
// the arm, as in joint_block.h. The blocks of L below it follow in memory, 3 x 3 or 1 x 3.
struct TurnGap {
  Eight free, yields, off[3], arm[2][3], inverse[6];
};
struct TurnLimit {  // J = gradient . (theta_1 - theta_0)
  Eight free, yields, off, gradient[3], low, high;
};

struct TurnRow {
  int body[2];            // -1: it does not move
  int numbers;            // of a gap: where its TurnGap begins
  int below, belowCount;  // of a gap
};

// Limits come last. Right sides and lambdas: three of each gap, then one of each limit.
struct TurnView {
  const TurnBody* bodies;
  TurnMotion* motions;
  int bodyCount;
  const TurnRow* rows;
  int gapCount, limitCount;
  const int* below;  // where the right side of a row below begins
  const Eight* numbers;
  TurnLimit* limits;
  Eight *right, *lambda;
  // What eliminating gaps leaves of A for the limits, L and D^-1 of those that are free, and what
  // those that are held give up: triangles by rows.
  const Eight* tail;
  Eight *factor, *held;
  char* gives;
  bool* isFactored;
};

struct TurnKernels {
  // From what the lanes move by to what they do where joints hold.
  void (*follow)(const TurnView&, LaneMotion*);
};

// Chosen once, by what the processor has.
const TurnKernels& turnKernels();
extern const TurnKernels kTurnKernelsSse2, kTurnKernelsAvx2;

}  // namespace physics
