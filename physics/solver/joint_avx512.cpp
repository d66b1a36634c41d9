// Joint kernels in AVX-512 registers: compiled with -mavx512f, called where the processor has it.
#include "physics/solver/joint_kernels.h"

namespace physics {

const JointKernels<8> kJointKernelsAvx512Of8 = tableOf<Eight>();

}  // namespace physics
