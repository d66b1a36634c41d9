// The kernels of bodies in AVX2 registers: compiled with -mavx2, called where the processor has it.
#include "physics/small_steps/body_kernels.h"

namespace physics {

const BodyKernels kBodyKernelsAvx2 = bodyTableOf<Four>();

}  // namespace physics
