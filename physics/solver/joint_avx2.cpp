// Joint kernels in AVX2 registers: compiled with -mavx2, called where the processor has it.
#define KERNELS(n) kJointKernelsAvx2Of##n
#include "physics/solver/joint_kernels.h"
