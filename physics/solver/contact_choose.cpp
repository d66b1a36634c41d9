// Which contact kernels this processor runs. All give the same bytes.
#include "physics/solver/contact_block.h"

namespace physics {
namespace {

ContactKernels chosen() {
  if (!__builtin_cpu_supports("avx2")) return kContactKernelsSse2;
  ContactKernels kernels = kContactKernelsAvx2;
  if (__builtin_cpu_supports("avx512f"))
    static_cast<ContactSweeps&>(kernels) = kContactSweepsAvx512;
  return kernels;
}

}  // namespace

const ContactKernels& contactKernels() {
  static const ContactKernels kernels = chosen();
  return kernels;
}

}  // namespace physics
