// The kernels of bodies in AVX-512 registers: compiled with -mavx512f, called where the processor
// has it.
#include "physics/small_steps/body_kernels.h"

namespace physics {

const BodyKernels kBodyKernelsAvx512 = bodyTableOf<Eight>();

}  // namespace physics
