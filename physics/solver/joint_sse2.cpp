// Joint kernels in two SSE2 halves: what every x86-64 has.
#include "physics/solver/joint_kernels.h"

namespace physics {

const JointKernels<1> kJointKernelsSse2Of1 = tableOf<One>();
const JointKernels<4> kJointKernelsSse2Of4 = tableOf<Four>();

}  // namespace physics
