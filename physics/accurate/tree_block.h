// The memory that the kernels of tree_kernels.h work in: a tree of bodies on ball sockets, four
// times, a motion to a lane.
#pragma once

#include "physics/solver/joint_block.h"

namespace physics {

constexpr int kTreeLanes = 4;
using TreeNum = Num<kTreeLanes>;

struct TreeBody {  // what is the same in all lanes
  bool turns = false;
  double mass = 0, inertia[3] = {0, 0, 0};  // 1/kg; principal [kg m^2]
  double pull[3] = {0, 0, 0};               // m/s^2
  double torque[3] = {0, 0, 0};             // N m
};

struct TreeMotion {  // turn w x y z, and rad/s
  TreeNum q[4], omega[3];
};

// Of a body in a kick: axes, what it accelerates by for a torque, by columns, and without joints.
struct TreeTurn {
  TreeNum axis[3][3], yields[3][3], free[3];
};

// Of a joint: arms, what an end accelerates by for a torque on its body, by columns.
struct TreeJoint {
  double anchor[2][3];
  TreeNum arm[2][3], yields[2][3][3], lambda[3];
};

struct TreeLink {  // of a walk from a root: the joint, and at which end of it one comes from
  int joint, from;
};

struct TreeView {
  const TreeBody* bodies;
  TreeMotion* motion;
  TreeTurn* turns;
  TreeJoint* joints;
  TreeNum *diagonal, *lower, *upper;  // nine by block, by columns
  int bodyCount, jointCount;
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
  void (*kick)(const TreeView&, const TreeNum& h);
};
extern const TreeKernels kTreeKernelsSse2, kTreeKernelsAvx2;
const TreeKernels& treeKernels();  // those that this processor runs: all give the same bytes

}  // namespace physics
