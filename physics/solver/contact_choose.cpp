// Which contact kernels this processor runs. Both give the same bytes.
#include "physics/solver/contact_block.h"

namespace physics {

const ContactKernels& contactKernels() {
  static const bool wide = __builtin_cpu_supports("avx2");
  return wide ? kContactKernelsAvx2 : kContactKernelsSse2;
}

}  // namespace physics
