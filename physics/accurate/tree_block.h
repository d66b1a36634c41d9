// The memory that the kernels of tree_kernels.h work in: a tree of bodies on ball sockets, or of
// points on links, four times, a motion to a lane.
#pragma once

#include "physics/solver/joint_block.h"

namespace physics {

constexpr int kTreeLanes = 4;
using TreeNum = Num<kTreeLanes>;

struct TreeBody {                           // what is the same in all lanes
  int turner = -1;                          // where its motion is; -1: it does not turn
  double mass = 0, inertia[3] = {0, 0, 0};  // 1/kg; principal [kg m^2]
  double pull[3] = {0, 0, 0};               // m/s^2
  double torque[3] = {0, 0, 0};             // N m
};

// Of a body on sockets, or of a link: turn w x y z, and rad/s.
struct TreeMotion {
  TreeNum q[4], omega[3];
};

// Of a body in a kick: axes, what it accelerates by for a torque, by columns, and without joints.
struct TreeTurn {
  TreeNum axis[3][3], yields[3][3], free[3];
};

// A joint. Of a socket: arms, and what an end accelerates by for a torque on its body, by columns.
// Of a link, from its first body to the other: the direction, and what its row is of, J'.
struct TreeJoint {
  double anchor[2][3];  // of a link: its direction where a motion starts
  double length;        // m, of a link
  TreeNum arm[2][3], yields[2][3][3], lambda[3];
};

struct TreeView {
  const TreeBody* bodies;
  TreeMotion* motion;
  TreeTurn* turns;  // of bodies on sockets
  TreeNum* alpha;   // of bodies on links, three by body: m/s^2
  TreeJoint* joints;
  TreeNum *diagonal, *lower, *upper;  // by block, nine by columns; of links, one
  int bodyCount, jointCount, motionCount;
  const JointShape* shapes;
  const JointColumn* columns;
  const JointBelow* below;
  const int* updates;
  const JointMeeting* meetings;
};

struct TreeKernels {
  void (*drift)(const TreeView&, const TreeNum& h);  // by h, at its spin
  // By h, at a pose, so that joints do not accelerate apart. What is a product of two spins is one
  // of that of the start and that of the end: symmetric, and linear. Kahan; of one body alone it is
  // the map of Hirota and Kimura.
  void (*kickSockets)(const TreeView&, const TreeNum& h);
  void (*kickLinks)(const TreeView&, const TreeNum& h);
};
extern const TreeKernels kTreeKernelsSse2, kTreeKernelsAvx2;
const TreeKernels& treeKernels();  // those that this processor runs: all give the same bytes

}  // namespace physics
