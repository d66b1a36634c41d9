// The kernels of bodies in SSE2 registers.
#include "physics/small_steps/body_kernels.h"

namespace physics {

const BodyKernels kBodyKernelsSse2 = bodyTableOf<Four>();

}  // namespace physics
