// Which joint kernels this processor runs. All give the same bytes.
#include "physics/base/rotation.h"
#include "physics/solver/joint_block.h"

namespace physics {

template <>
const JointKernels<1>& jointKernels<1>() {
  static const bool wide = __builtin_cpu_supports("avx2");
  return wide ? kJointKernelsAvx2Of1 : kJointKernelsSse2Of1;
}

template <>
const JointKernels<4>& jointKernels<4>() {
  static const bool wide = __builtin_cpu_supports("avx2");
  return wide ? kJointKernelsAvx2Of4 : kJointKernelsSse2Of4;
}

template <>
const JointKernels<8>& jointKernels<8>() {
  return kJointKernelsAvx512Of8;
}

int mostJointLanes() {
  static const bool widest = __builtin_cpu_supports("avx512f");
  return widest ? 8 : 4;
}

void turnFar(const double (&theta)[3], double (&q)[4]) {
  const Quat turn = exponential({theta[0], theta[1], theta[2]});
  q[0] = turn.w(), q[1] = turn.x(), q[2] = turn.y(), q[3] = turn.z();
}

void normalTo(const double (&n)[3], double (&w)[3]) {
  const Vec3 normal = anyNormalTo({n[0], n[1], n[2]});
  for (int k = 0; k < 3; ++k) w[k] = normal[k];
}

}  // namespace physics
