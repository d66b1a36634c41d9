// Joint kernels in AVX2 registers: compiled with -mavx2, called where the processor has it.
#include "physics/solver/joint_kernels.h"

namespace physics {

const JointKernels<1> kJointKernelsAvx2Of1 = tableOf<One>();
const JointKernels<4> kJointKernelsAvx2Of4 = tableOf<Four>();

}  // namespace physics
