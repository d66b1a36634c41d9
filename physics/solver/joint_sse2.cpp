// Joint kernels in two SSE2 halves: what every x86-64 has.
#define KERNELS(n) kJointKernelsSse2Of##n
#include "physics/solver/joint_kernels.h"
